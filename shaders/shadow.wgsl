// The surface's shadow on the ground.
#include "lib/frame.wgsl"
#include "lib/ground.wgsl"

// `ShadowUniform` in crates/render/src/frame/uniforms.rs.
struct Shadow {
    // The middle of the square that it covers, relative to the centre.
    middle: vec3f,
    // Half the square's side in world units.
    half_side: f32,
    // The square's axes: unit vectors, whose cross product points up.
    along_u: vec3f,
    padding: f32,
    along_v: vec3f,
    padding_to_16: f32,
}

@group(1) @binding(0) var<uniform> shadow: Shadow;
@group(1) @binding(1) var occlusion: texture_2d<f32>;
@group(1) @binding(2) var occlusion_sampler: sampler;

// The share of light that is lost under parts that touch the ground, and under parts above it.
const TOUCHING: f32 = 0.8;
const OVER: f32 = 0.65;

struct ShadowFragment {
    @builtin(position) position_clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) position_view: vec3f,
}

@vertex
fn vs_shadow(@builtin(vertex_index) vertex: u32) -> ShadowFragment {
    let corner = square_corner(vertex);
    let offset = corner * shadow.half_side;
    let position = vec4f(shadow.middle + shadow.along_u * offset.x + shadow.along_v * offset.y, 1.0);
    var out: ShadowFragment;
    out.position_clip = frame.clip_from_world * position;
    out.uv = vec2f(0.5, -0.5) * corner + 0.5;
    out.position_view = (frame.view_from_world * position).xyz;
    return out;
}

@fragment
fn fs_shadow(in: ShadowFragment) -> @location(0) vec4f {
    let occluded = textureSample(occlusion, occlusion_sampler, in.uv).rg;
    let up_view = (frame.view_from_world * vec4f(cross(shadow.along_u, shadow.along_v), 0.0)).xyz;
    // From below, the ground would lie over the surface.
    let seen = smoothstep(0.0, 0.1, dot(up_view, direction_to_eye(in.position_view)));
    let lit = (1.0 - TOUCHING * occluded.r) * (1.0 - OVER * occluded.g);
    return vec4f(0.0, 0.0, 0.0, (1.0 - lit) * seen);
}
