// Surfaces whose look is the program's: clay under a studio's lamps, colours to be read against a legend, reflected
// stripes, and normals.
#include "lib/frame.wgsl"
#include "lib/colour.wgsl"
#include "lib/surface_vertex.wgsl"
#include "lib/surface_shape.wgsl"
#include "lib/tone.wgsl"

// A clay: `ClayUniform` in crates/render/src/uniforms.rs. Its studio is the texture, a sphere seen from the eye: the
// left half is the light that its colour is multiplied by, halved; the right half is gloss to be added.
struct Clay {
    // Linear.
    colour: vec4f,
    // The inside, where an open surface shows its back.
    inside: vec4f,
    // What the studio's light is multiplied by where it falls on a region's colour, and in w, its gloss.
    on_regions: vec4f,
}

@group(2) @binding(0) var<uniform> clay: Clay;
@group(2) @binding(1) var studio: texture_2d<f32>;
@group(2) @binding(2) var studio_sampler: sampler;

struct SurfaceFragment {
    @builtin(position) @invariant position_clip: vec4f,
    // Not of unit length.
    @location(0) normal_view: vec3f,
    @location(1) position_view: vec3f,
    // Linear, in alpha how much of the surface's own colour it replaces.
    @location(2) region: vec4f,
}

@vertex
fn vs_surface(vertex: SurfaceVertex) -> SurfaceFragment {
    var out: SurfaceFragment;
    out.position_clip = clip_from_vertex(vertex.position);
    out.normal_view = normal_to_view(vertex.normal);
    out.position_view = position_to_view(vertex.position);
    out.region = region_share(vertex.region);
    return out;
}

// Where a normal is on the studio's sphere, which is seen from the eye wherever in the picture it is.
fn on_sphere(n: vec3f, to_eye: vec3f) -> vec2f {
    let right = normalize(cross(vec3f(0.0, 1.0, 0.0), to_eye));
    let up = cross(to_eye, right);
    return 0.49 * vec2f(dot(n, right), -dot(n, up)) + 0.5;
}

struct Studio {
    diffuse: vec3f,
    gloss: vec3f,
}

fn studio_light(n: vec3f, to_eye: vec3f) -> Studio {
    let at = on_sphere(n, to_eye);
    var out: Studio;
    out.diffuse = 2.0 * textureSampleLevel(studio, studio_sampler, vec2f(0.5 * at.x, at.y), 0.0).rgb;
    out.gloss = textureSampleLevel(studio, studio_sampler, vec2f(0.5 * at.x + 0.5, at.y), 0.0).rgb;
    return out;
}

@fragment
fn fs_clay(in: SurfaceFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let to_eye = direction_to_eye(in.position_view);
    let n = seen_normal(in.normal_view, in.position_view, to_eye, is_front);
    let light = studio_light(n, to_eye);
    let colour = under_region(select(clay.inside.rgb, clay.colour.rgb, is_front), in.region);
    // Lamps that suit a dark clay would bleach a region's colour, and coloured ones change it.
    let diffuse = light.diffuse * mix(vec3f(1.0), clay.on_regions.rgb, in.region.a);
    let gloss = light.gloss * mix(1.0, clay.on_regions.w, in.region.a);
    return vec4f(rolled_off(colour * diffuse + gloss), 1.0);
}

// Colours that carry numbers: shaded just enough to show the form, so that they still match their legend.
@fragment
fn fs_painted(in: SurfaceFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let to_eye = direction_to_eye(in.position_view);
    let n = seen_normal(in.normal_view, in.position_view, to_eye, is_front);
    let light = studio_light(n, to_eye).diffuse.g;
    let colour = under_region(clay.colour.rgb, in.region);
    return vec4f(colour * (0.52 + 0.48 * min(light, 1.15)), 1.0);
}

// Stripes of a striped room, mirrored: they break where normals jump, and kink where curvature does.
@fragment
fn fs_zebra(in: SurfaceFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    const STRIPES: f32 = 7.0;
    let to_eye = direction_to_eye(in.position_view);
    let n = seen_normal(in.normal_view, in.position_view, to_eye, is_front);
    let mirrored = 2.0 * dot(n, to_eye) * n - to_eye;
    // Rings about the room's upright axis, evenly spaced by angle.
    let height = acos(clamp(mirrored.y, -0.9999, 0.9999)) * (STRIPES / 3.14159265);
    let saw = abs(fract(height) - 0.5) * 4.0 - 1.0;
    let sharp = 4.0 * max(fwidth(height), 1e-4);
    let stripe = clamp(saw / sharp + 0.5, 0.0, 1.0);
    let washed = mix(stripe, 0.5, clamp(fwidth(height) - 0.6, 0.0, 1.0));
    let form = 0.80 + 0.20 * max(dot(n, to_eye), 0.0);
    let shade = mix(0.018, 0.80, washed) * form * select(0.45, 1.0, is_front);
    return vec4f(under_region(vec3f(shade), in.region), 1.0);
}

// Which way the surface faces in the world: red along x, green along y, blue along z.
@fragment
fn fs_normals(in: SurfaceFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let to_eye = direction_to_eye(in.position_view);
    let n = seen_normal(in.normal_view, in.position_view, to_eye, is_front);
    let world_from_view = transpose(mat3x3f(
        frame.view_from_world[0].xyz,
        frame.view_from_world[1].xyz,
        frame.view_from_world[2].xyz,
    ));
    let encoded = 0.5 + 0.5 * (world_from_view * n);
    return vec4f(linear_from_srgb(encoded), 1.0);
}
