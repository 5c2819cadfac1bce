// What every drawing of a surface shares: its uniform, and the one place where its vertices come to the screen, so that
// picture, edges and triangle numbers can't disagree.
struct Surface {
    // Triangle number of the surface's first triangle among all of the frame's, plus 1.
    id_base: u32,
    // 1 when vertex colours are linear light, 0 when they are sRGB.
    colours_are_linear: u32,
    // Mean length of an edge, in world units.
    mean_edge: f32,
    padding: u32,
}

@group(1) @binding(0) var<uniform> surface: Surface;

fn clip_from_vertex(position: vec3f) -> vec4f {
    return frame.clip_from_world * vec4f(position, 1.0);
}
