// Squares on the ground, drawn as strips of four vertices.

// The corner of the square from (-1, -1) to (1, 1) for a vertex.
fn square_corner(vertex: u32) -> vec2f {
    return vec2f(f32(vertex & 1u), f32(vertex >> 1u)) * 2.0 - 1.0;
}
