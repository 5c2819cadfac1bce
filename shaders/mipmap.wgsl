// One mip level from the next finer one. Views of sRGB textures decode and encode, so the mean is taken in linear
// light.
@group(0) @binding(0) var finer: texture_2d<f32>;
@group(0) @binding(1) var finer_sampler: sampler;

struct MipmapFragment {
    @builtin(position) position_clip: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn vs_mipmap(@builtin(vertex_index) vertex: u32) -> MipmapFragment {
    let corner = vec2f(f32((vertex << 1u) & 2u), f32(vertex & 2u));
    var out: MipmapFragment;
    out.position_clip = vec4f(corner.x * 2.0 - 1.0, 1.0 - corner.y * 2.0, 0.0, 1.0);
    out.uv = corner;
    return out;
}

@fragment
fn fs_mipmap(in: MipmapFragment) -> @location(0) vec4f {
    return textureSampleLevel(finer, finer_sampler, in.uv, 0.0);
}
