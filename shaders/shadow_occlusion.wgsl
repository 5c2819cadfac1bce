// The height of the surface just above the ground, seen from below the ground.
#include "lib/frame.wgsl"
#include "lib/surface_vertex.wgsl"

// Depth is 1 on the ground and falls to 0 where the surface is too high to be seen.
@vertex
fn vs_occlusion(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return clip_from_vertex(position);
}

// Red marks parts that nearly touch the ground, green marks parts above it.
@fragment
fn fs_occlusion(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let near = position.z;
    return vec4f(pow(near, 16.0), near * near, 0.0, 1.0);
}
