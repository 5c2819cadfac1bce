// Overlay triangles: drawn once where they are visible and once, fainter, where a surface hides them.
#include "lib/frame.wgsl"
#include "lib/colour.wgsl"

struct OverlayVertex {
    @location(0) position: vec3f,
    // sRGB with straight alpha.
    @location(1) colour: vec4f,
    @location(2) hidden_share: f32,
}

struct OverlayFragment {
    @builtin(position) position_clip: vec4f,
    @location(0) colour: vec4f,
    @location(1) hidden_share: f32,
}

@vertex
fn vs_overlay_triangle(vertex: OverlayVertex) -> OverlayFragment {
    var out: OverlayFragment;
    out.position_clip = frame.clip_from_world * vec4f(vertex.position, 1.0);
    out.position_clip.z *= 1.0015;
    out.colour = premultiplied_from_srgb(vertex.colour, 1.0);
    out.hidden_share = vertex.hidden_share;
    return out;
}

@fragment
fn fs_visible(in: OverlayFragment) -> @location(0) vec4f {
    return in.colour;
}

@fragment
fn fs_hidden(in: OverlayFragment) -> @location(0) vec4f {
    return in.colour * in.hidden_share;
}
