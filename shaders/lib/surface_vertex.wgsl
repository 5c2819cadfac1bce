// The common part of all shaders of a surface: its uniform, and the one function that projects its vertices, so that
// picture, edges and ids agree exactly.
struct Surface {
    // The id of the surface's first triangle in the frame; ids start at 1.
    id_base: u32,
    // 1 when vertex colours are linear light, 0 when they are sRGB.
    colours_are_linear: u32,
    // Mean edge length in world units.
    mean_edge: f32,
    padding: u32,
}

@group(1) @binding(0) var<uniform> surface: Surface;

fn clip_from_vertex(position: vec3f) -> vec4f {
    return frame.clip_from_world * vec4f(position, 1.0);
}
