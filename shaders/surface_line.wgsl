// Lines on the surface with a width in points, one instance per line. Their ends lie on edges of triangles and are
// computed from the surface's positions, so they follow the surface without an upload.
#include "lib/frame.wgsl"
#include "lib/colour.wgsl"
#include "lib/surface_vertex.wgsl"
#include "lib/line.wgsl"

@group(2) @binding(0) var<storage, read> positions: array<f32>;

struct SurfaceLine {
    // Each end lies on the edge between two vertices, ...
    @location(0) start: vec2u,
    @location(1) end: vec2u,
    // ... at this fraction from the first to the second.
    @location(2) shares: vec2f,
    @location(3) width_points: f32,
    @location(4) hidden_share: f32,
    // sRGB.
    @location(5) colour: vec4f,
}

fn position_of(vertex: u32) -> vec3f {
    return vec3f(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

fn between(vertices: vec2u, share: f32) -> vec3f {
    return mix(position_of(vertices.x), position_of(vertices.y), share);
}

@vertex
fn vs_surface_line(@builtin(vertex_index) corner: u32, line: SurfaceLine) -> LineFragment {
    let colour = premultiplied_from_srgb(line.colour, 1.0);
    let start = between(line.start, line.shares.x);
    let end = between(line.end, line.shares.y);
    let width_px = line.width_points * frame.pixels_per_point;
    return widened(corner, start, end, width_px, 0.5 * width_px, colour, colour, line.hidden_share);
}

// Round caps close the gaps where lines bend.
@fragment
fn fs_visible(in: LineFragment) -> @location(0) vec4f {
    return in.colour * coverage(in);
}

// No caps here: overlapping caps of transparent lines would be darker than the rest.
@fragment
fn fs_hidden(in: LineFragment) -> @location(0) vec4f {
    return in.colour * (coverage(in) * in.hidden_share * f32(beyond_px(in) <= 0.0));
}
