// A vertical gradient behind everything, drawn as a fullscreen triangle.
#include "lib/frame.wgsl"
#include "lib/colour.wgsl"

struct BackgroundFragment {
    @builtin(position) position_clip: vec4f,
    // 0 at the bottom, 1 at the top.
    @location(0) height: f32,
}

@vertex
fn vs_background(@builtin(vertex_index) vertex: u32) -> BackgroundFragment {
    let corner = vec2f(f32((vertex << 1u) & 2u), f32(vertex & 2u));
    var out: BackgroundFragment;
    // Depth 0 is infinity.
    out.position_clip = vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
    out.height = corner.y;
    return out;
}

@fragment
fn fs_background(in: BackgroundFragment) -> @location(0) vec4f {
    let encoded = mix(frame.background_bottom.rgb, frame.background_top.rgb, smoothstep(0.0, 1.0, frame.background_span.x + frame.background_span.y * in.height));
    // Dither by half a step against banding: interleaved gradient noise [Jim14].
    let noise = fract(52.9829189 * fract(dot(floor(in.position_clip.xy), vec2f(0.06711056, 0.00583715))));
    return vec4f(linear_from_srgb(encoded + (noise - 0.5) / 255.0), 1.0);
}
