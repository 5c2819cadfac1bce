// The edges of a surface as thin lines, slightly in front of it.
#include "lib/frame.wgsl"
#include "lib/surface_vertex.wgsl"

struct WireFragment {
    @builtin(position) position_clip: vec4f,
    @location(0) alpha: f32,
}

@vertex
fn vs_wireframe(@location(0) position: vec3f) -> WireFragment {
    var out: WireFragment;
    out.position_clip = clip_from_vertex(position);
    // Depth grows towards the eye, so a factor lifts lines off their faces at any distance.
    out.position_clip.z *= 1.0006;
    // Edges shorter than a few pixels would blacken the surface, so they fade.
    let edge_px = surface.mean_edge * frame.scale_px / max(out.position_clip.w, 1e-6);
    out.alpha = clamp((edge_px - 0.5) / 10.0, 0.06, 0.62);
    return out;
}

@fragment
fn fs_wireframe(in: WireFragment) -> @location(0) vec4f {
    return vec4f(vec3f(0.012, 0.012, 0.016) * in.alpha, in.alpha);
}
