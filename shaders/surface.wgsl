// The editor's own shadings of a surface: matcaps, colours that encode numbers, reflection lines, and normals.
#include "lib/frame.wgsl"
#include "lib/colour.wgsl"
#include "lib/surface_vertex.wgsl"
#include "lib/surface_shape.wgsl"
#include "lib/tone.wgsl"

// `MatcapUniform` in crates/render/src/frame/uniforms.rs. The matcap texture is a sphere seen from the eye: its left
// half is half the diffuse light, by which the colour is multiplied; its right half is the specular light, which is
// added.
struct Matcap {
    // Linear.
    colour: vec4f,
    // Colour of back faces, which an open surface shows.
    inside: vec4f,
    // Factors of the diffuse light on region colours and, in w, of the specular light.
    on_regions: vec4f,
}

@group(2) @binding(0) var<uniform> matcap: Matcap;
@group(2) @binding(1) var matcap_texture: texture_2d<f32>;
@group(2) @binding(2) var matcap_sampler: sampler;

struct SurfaceFragment {
    @builtin(position) @invariant position_clip: vec4f,
    // Not a unit vector.
    @location(0) normal_view: vec3f,
    @location(1) position_view: vec3f,
    // As `region_share` gives it; alpha is the share of the surface's own colour that it replaces.
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

// A normal's point on the matcap's sphere. The sphere always faces the eye, wherever the fragment is in the picture.
fn matcap_uv(n: vec3f, to_eye: vec3f) -> vec2f {
    let right = normalize(cross(vec3f(0.0, 1.0, 0.0), to_eye));
    let up = cross(to_eye, right);
    return 0.49 * vec2f(dot(n, right), -dot(n, up)) + 0.5;
}

struct MatcapLight {
    diffuse: vec3f,
    specular: vec3f,
}

fn matcap_light(n: vec3f, to_eye: vec3f) -> MatcapLight {
    let uv = matcap_uv(n, to_eye);
    var out: MatcapLight;
    out.diffuse = 2.0 * textureSampleLevel(matcap_texture, matcap_sampler, vec2f(0.5 * uv.x, uv.y), 0.0).rgb;
    out.specular = textureSampleLevel(matcap_texture, matcap_sampler, vec2f(0.5 * uv.x + 0.5, uv.y), 0.0).rgb;
    return out;
}

@fragment
fn fs_matcap(in: SurfaceFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let to_eye = direction_to_eye(in.position_view);
    let n = seen_normal(in.normal_view, in.position_view, to_eye, is_front);
    let light = matcap_light(n, to_eye);
    let colour = under_region(select(matcap.inside.rgb, matcap.colour.rgb, is_front), in.region);
    // Lights made for a dark clay would bleach a region's colour, and coloured lights would change its hue.
    let diffuse = light.diffuse * mix(vec3f(1.0), matcap.on_regions.rgb, in.region.a);
    let specular = light.specular * mix(1.0, matcap.on_regions.w, in.region.a);
    return vec4f(rolled_off(colour * diffuse + specular), 1.0);
}

// Colours that encode numbers: shaded just enough to show the form, so that they still match their legend.
@fragment
fn fs_painted(in: SurfaceFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let to_eye = direction_to_eye(in.position_view);
    let n = seen_normal(in.normal_view, in.position_view, to_eye, is_front);
    let light = matcap_light(n, to_eye).diffuse.g;
    let colour = under_region(matcap.colour.rgb, in.region);
    return vec4f(colour * (0.52 + 0.48 * min(light, 1.15)), 1.0);
}

// Reflection lines of a striped room: they break where normals jump and kink where curvature jumps.
@fragment
fn fs_zebra(in: SurfaceFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    const STRIPES: f32 = 7.0;
    let to_eye = direction_to_eye(in.position_view);
    let n = seen_normal(in.normal_view, in.position_view, to_eye, is_front);
    let mirrored = 2.0 * dot(n, to_eye) * n - to_eye;
    // Rings around the vertical axis, evenly spaced by angle.
    let height = acos(clamp(mirrored.y, -0.9999, 0.9999)) * (STRIPES / 3.14159265);
    let saw = abs(fract(height) - 0.5) * 4.0 - 1.0;
    let sharp = 4.0 * max(fwidth(height), 1e-4);
    let stripe = clamp(saw / sharp + 0.5, 0.0, 1.0);
    let washed = mix(stripe, 0.5, clamp(fwidth(height) - 0.6, 0.0, 1.0));
    let form = 0.80 + 0.20 * max(dot(n, to_eye), 0.0);
    let shade = mix(0.018, 0.80, washed) * form * select(0.45, 1.0, is_front);
    return vec4f(under_region(vec3f(shade), in.region), 1.0);
}

// World-space normals as colours: red is x, green y, blue z.
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
