// Surfaces: clay (with or without region colours), and the file's materials.
#include "lib/frame.wgsl"
#include "lib/colour.wgsl"
#include "lib/surface_vertex.wgsl"
#include "lib/light.wgsl"

// Linear albedo of the clay, and of its inside where an open surface shows its back.
const CLAY: vec3f = vec3f(0.470, 0.418, 0.366);
const CLAY_INSIDE: vec3f = vec3f(0.215, 0.160, 0.140);

struct Material {
    base_colour: vec4f,
    // Fragments of less alpha are not drawn.
    alpha_cutoff: f32,
    // What the light of a back face is multiplied by.
    back_share: f32,
    padding: vec2f,
}

@group(2) @binding(0) var<uniform> material: Material;
@group(2) @binding(1) var base_colour_texture: texture_2d<f32>;
@group(2) @binding(2) var base_colour_sampler: sampler;

@fragment
fn fs_clay(in: SurfaceFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let to_eye = normalize(in.to_eye_view);
    let n = seen_normal(in.normal_view, to_eye, is_front);
    let lamps = light(n, to_eye);
    let albedo = mix(select(CLAY_INSIDE, CLAY, is_front), in.region.rgb, in.region.a);
    // Clay darkens a little towards its contour before the rim lights it: forms separate where they overlap.
    let contour = 1.0 - 0.42 * lamps.grazing * lamps.grazing;
    let colour = albedo * lamps.diffuse * contour + 0.075 * lamps.specular;
    return vec4f(rolled_off(colour), 1.0);
}

fn material_base(in: SurfaceFragment) -> vec4f {
    let base = material.base_colour * in.colour * textureSample(base_colour_texture, base_colour_sampler, in.uv);
    return vec4f(mix(base.rgb, in.region.rgb, in.region.a), base.a);
}

fn lit_material(in: SurfaceFragment, is_front: bool, base: vec3f) -> vec3f {
    let to_eye = normalize(in.to_eye_view);
    let n = seen_normal(in.normal_view, to_eye, is_front);
    let lamps = light(n, to_eye);
    let fresnel = 0.04 + 0.25 * lamps.grazing * lamps.grazing * lamps.grazing;
    let colour = 1.22 * base * lamps.diffuse + (2.2 * fresnel) * lamps.specular;
    return rolled_off(colour) * select(material.back_share, 1.0, is_front);
}

@fragment
fn fs_material_opaque(in: SurfaceFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    return vec4f(lit_material(in, is_front, material_base(in).rgb), 1.0);
}

@fragment
fn fs_material_mask(in: SurfaceFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let base = material_base(in);
    if base.a < material.alpha_cutoff {
        discard;
    }
    return vec4f(lit_material(in, is_front, base.rgb), 1.0);
}

@fragment
fn fs_material_blend(in: SurfaceFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let base = material_base(in);
    return vec4f(lit_material(in, is_front, base.rgb) * base.a, base.a);
}
