// Triangle numbers instead of colours: 0 is no triangle.
enable primitive_index;
#include "lib/frame.wgsl"
#include "lib/colour.wgsl"
#include "lib/surface_vertex.wgsl"

@fragment
fn fs_id(in: SurfaceFragment, @builtin(primitive_index) triangle: u32) -> @location(0) u32 {
    return surface.id_base + triangle;
}
