// The file's materials: glTF's metallic-roughness model under image-based light and a key light.
#include "lib/frame.wgsl"
#include "lib/colour.wgsl"
#include "lib/surface_vertex.wgsl"
#include "lib/surface_shape.wgsl"
#include "lib/tone.wgsl"
#include "lib/reflectance.wgsl"

// A texture transform: two rows that multiply (u, v, 1). `u.w` is 0 for the first set of texture coordinates, 1 for the
// second.
struct Map {
    u: vec4f,
    v: vec4f,
}

// `MaterialUniform` in crates/render/src/frame/uniforms.rs.
struct Material {
    base_colour: vec4f,
    // Alpha is the cutoff: fragments with less alpha are discarded.
    emissive: vec4f,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,
    occlusion_strength: f32,
    // Factor of the light on back faces; 0 hides the back faces of blended materials.
    back_share: f32,
    // The bits below: the textures that exist, and the material's lighting.
    flags: u32,
    padding: vec2f,
    metallic_roughness: Map,
    normal: Map,
    occlusion: Map,
    emission: Map,
}

const HAS_BASE_COLOUR: u32 = 1u;
const HAS_METALLIC_ROUGHNESS: u32 = 2u;
const HAS_NORMAL: u32 = 4u;
const HAS_OCCLUSION: u32 = 8u;
const HAS_EMISSION: u32 = 16u;
const IS_UNLIT: u32 = 32u;

// Makes a white surface that faces the eye as bright as its base colour.
const EXPOSURE: f32 = 0.86;

@group(2) @binding(0) var<uniform> material: Material;
@group(2) @binding(1) var base_colour_image: texture_2d<f32>;
@group(2) @binding(2) var base_colour_sampler: sampler;
@group(2) @binding(3) var metallic_roughness_image: texture_2d<f32>;
@group(2) @binding(4) var metallic_roughness_sampler: sampler;
@group(2) @binding(5) var normal_image: texture_2d<f32>;
@group(2) @binding(6) var normal_sampler: sampler;
@group(2) @binding(7) var occlusion_image: texture_2d<f32>;
@group(2) @binding(8) var occlusion_sampler: sampler;
@group(2) @binding(9) var emission_image: texture_2d<f32>;
@group(2) @binding(10) var emission_sampler: sampler;

@group(3) @binding(0) var prefiltered_environment: texture_cube<f32>;
@group(3) @binding(1) var irradiance_map: texture_cube<f32>;
@group(3) @binding(2) var environment_sampler: sampler;

// The vertex attributes that only materials read; one entry for all vertices if a file has neither.
struct MaterialVertex {
    // Two sets of texture coordinates.
    @location(3) uvs: vec4f,
    @location(4) colour: vec4f,
}

struct MaterialFragment {
    @builtin(position) @invariant position_clip: vec4f,
    @location(0) normal_view: vec3f,
    @location(1) position_view: vec3f,
    @location(2) region: vec4f,
    @location(3) uvs: vec4f,
    // The file's vertex colour, linear.
    @location(4) colour: vec4f,
}

@vertex
fn vs_material(vertex: SurfaceVertex, attributes: MaterialVertex) -> MaterialFragment {
    var out: MaterialFragment;
    out.position_clip = clip_from_vertex(vertex.position);
    out.normal_view = normal_to_view(vertex.normal);
    out.position_view = position_to_view(vertex.position);
    out.region = region_share(vertex.region);
    out.uvs = attributes.uvs;
    let decoded = linear_from_srgb_fast(attributes.colour.rgb);
    out.colour = vec4f(select(decoded, attributes.colour.rgb, surface.colours_are_linear == 1u), attributes.colour.a);
    return out;
}

fn has(flag: u32) -> bool {
    return (material.flags & flag) != 0u;
}

fn transformed(map: Map, uvs: vec4f) -> vec2f {
    let uv = vec3f(mix(uvs.xy, uvs.zw, map.u.w), 1.0);
    return vec2f(dot(map.u.xyz, uv), dot(map.v.xyz, uv));
}

fn base_of(in: MaterialFragment) -> vec4f {
    var base = material.base_colour * in.colour;
    if has(HAS_BASE_COLOUR) {
        base *= textureSample(base_colour_image, base_colour_sampler, in.uvs.xy);
    }
    return vec4f(under_region(base.rgb, in.region), base.a);
}

// The normal map applied to `n`. The cotangent frame comes from screen-space derivatives [Sch13], so it follows a
// bending surface and no file needs tangents.
fn mapped_normal(in: MaterialFragment, n: vec3f) -> vec3f {
    let uv = transformed(material.normal, in.uvs);
    let sampled = textureSample(normal_image, normal_sampler, uv).xyz * 2.0 - 1.0;
    let along_x = dpdx(in.position_view);
    let along_y = dpdy(in.position_view);
    let uv_x = dpdx(uv);
    let uv_y = dpdy(uv);
    let across_y = cross(along_y, n);
    let across_x = cross(n, along_x);
    // Screen y points down, so a front face has a negative determinant.
    let side = select(-1.0, 1.0, dot(along_x, across_y) > 0.0);
    let tangent = (across_y * uv_x.x + across_x * uv_y.x) * side;
    // Against v: images are stored from the top, but the normal map's y points up.
    let bitangent = -(across_y * uv_x.y + across_x * uv_y.y) * side;
    let longest = max(dot(tangent, tangent), dot(bitangent, bitangent));
    if longest < 1e-30 {
        return n;
    }
    let scale = inverseSqrt(longest) * material.normal_scale;
    let turned = tangent * (sampled.x * scale) + bitangent * (sampled.y * scale) + n * sampled.z;
    let length_squared = dot(turned, turned);
    return select(n, turned * inverseSqrt(length_squared), length_squared > 1e-12);
}

fn lit(in: MaterialFragment, is_front: bool, base: vec3f) -> vec3f {
    let to_eye = direction_to_eye(in.position_view);
    var n = seen_normal(in.normal_view, in.position_view, to_eye, is_front);
    var metallic = material.metallic;
    var roughness = material.roughness;
    var ambient_share = 1.0;
    var emission = material.emissive.rgb;
    if has(HAS_METALLIC_ROUGHNESS) {
        let uv = transformed(material.metallic_roughness, in.uvs);
        let sampled = textureSample(metallic_roughness_image, metallic_roughness_sampler, uv);
        metallic *= sampled.b;
        roughness *= sampled.g;
    }
    if has(HAS_NORMAL) {
        n = mapped_normal(in, n);
    }
    if has(HAS_OCCLUSION) {
        let uv = transformed(material.occlusion, in.uvs);
        let sampled = textureSample(occlusion_image, occlusion_sampler, uv).r;
        ambient_share = 1.0 + material.occlusion_strength * (sampled - 1.0);
    }
    if has(HAS_EMISSION) {
        emission *= textureSample(emission_image, emission_sampler, transformed(material.emission, in.uvs)).rgb;
    }
    let paint = in.region.a;
    // Region colours are rough and not metallic, so that they stay recognisable.
    let point = shading_point(base, metallic * (1.0 - paint), mix(roughness, 0.75, paint), n, to_eye);
    let level = point.roughness * f32(textureNumLevels(prefiltered_environment) - 1u);
    let prefiltered = textureSampleLevel(prefiltered_environment, environment_sampler, point.reflected, level).rgb;
    let irradiance = textureSampleLevel(irradiance_map, environment_sampler, n, 0.0).rgb;
    let ambient = environment_light(point, prefiltered, irradiance, ambient_share);
    let light = EXPOSURE * (ambient + key_light(point, n, to_eye)) + emission;
    return neutral_tone_mapped(light) * select(material.back_share, 1.0, is_front);
}

fn shown(in: MaterialFragment, is_front: bool, base: vec3f) -> vec3f {
    // Sample every texture on every path: derivatives need uniform control flow.
    let light = lit(in, is_front, base);
    return select(light, base, has(IS_UNLIT));
}

@fragment
fn fs_material_opaque(in: MaterialFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    return vec4f(shown(in, is_front, base_of(in).rgb), 1.0);
}

@fragment
fn fs_material_mask(in: MaterialFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let base = base_of(in);
    let colour = shown(in, is_front, base.rgb);
    if base.a < material.emissive.a {
        discard;
    }
    return vec4f(colour, 1.0);
}

@fragment
fn fs_material_blend(in: MaterialFragment, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let base = base_of(in);
    let colour = shown(in, is_front, base.rgb) * base.a;
    let seen = select(0.0, 1.0, is_front || material.back_share > 0.0);
    return vec4f(colour, base.a) * seen;
}
