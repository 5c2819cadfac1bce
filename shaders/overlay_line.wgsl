// Overlay lines, one instance per line. Drawn twice, like overlay triangles.
#include "lib/frame.wgsl"
#include "lib/colour.wgsl"
#include "lib/line.wgsl"

struct OverlayLine {
    @location(0) start: vec3f,
    @location(1) width_px: f32,
    @location(2) end: vec3f,
    @location(3) hidden_share: f32,
    // sRGB with straight alpha.
    @location(4) start_colour: vec4f,
    @location(5) end_colour: vec4f,
}

@vertex
fn vs_overlay_line(@builtin(vertex_index) corner: u32, line: OverlayLine) -> LineFragment {
    let start_colour = premultiplied_from_srgb(line.start_colour, 1.0);
    let end_colour = premultiplied_from_srgb(line.end_colour, 1.0);
    return widened(corner, line.start, line.end, line.width_px, 0.0, start_colour, end_colour, line.hidden_share);
}

@fragment
fn fs_visible(in: LineFragment) -> @location(0) vec4f {
    return in.colour * coverage(in);
}

@fragment
fn fs_hidden(in: LineFragment) -> @location(0) vec4f {
    return in.colour * (coverage(in) * in.hidden_share);
}
