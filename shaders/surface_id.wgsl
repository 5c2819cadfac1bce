// The id buffer: triangle ids in place of colours; 0 is no triangle.
enable primitive_index;
#include "lib/frame.wgsl"
#include "lib/surface_vertex.wgsl"

struct IdFragment {
    @builtin(position) @invariant position_clip: vec4f,
    @location(0) @interpolate(flat) first_triangle: u32,
}

// The primitive index starts at 0 in each draw call, so the instance index carries the first triangle's.
@vertex
fn vs_id(@location(0) position: vec3f, @builtin(instance_index) first_triangle: u32) -> IdFragment {
    var out: IdFragment;
    out.position_clip = clip_from_vertex(position);
    out.first_triangle = first_triangle;
    return out;
}

@fragment
fn fs_id(in: IdFragment, @builtin(primitive_index) triangle: u32) -> @location(0) u32 {
    return surface.id_base + in.first_triangle + triangle;
}
