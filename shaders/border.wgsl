// Edges that a closed, well-behaved surface lacks, as lines of a width in pixels: one instance an edge, whose ends are
// looked up among the surface's positions, so that they follow it without an upload of their own.
#include "lib/frame.wgsl"
#include "lib/colour.wgsl"
#include "lib/surface_vertex.wgsl"
#include "lib/line.wgsl"

@group(2) @binding(0) var<storage, read> positions: array<f32>;

struct BorderEdge {
    @location(0) ends: vec2u,
    // sRGB.
    @location(1) colour: vec4f,
}

fn position_of(vertex: u32) -> vec3f {
    return vec3f(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

@vertex
fn vs_border(@builtin(vertex_index) corner: u32, edge: BorderEdge) -> LineFragment {
    const WIDTH_PX: f32 = 2.6;
    let colour = premultiplied_from_srgb(edge.colour, 1.0);
    return widened(corner, position_of(edge.ends.x), position_of(edge.ends.y), WIDTH_PX, colour, colour, 0.22);
}

@fragment
fn fs_visible(in: LineFragment) -> @location(0) vec4f {
    return in.colour * coverage(in);
}

@fragment
fn fs_hidden(in: LineFragment) -> @location(0) vec4f {
    return in.colour * (coverage(in) * in.hidden_share);
}
