// A Gaussian blur of the picture that `shadow_occlusion.wgsl` draws: narrow where the surface nearly touches the ground
// (red), wide where it is higher (green). First across, then down.
@group(0) @binding(0) var occlusion: texture_2d<f32>;

// In pixels; the taps reach twice as far as the wider one.
const NARROW: f32 = 2.5;
const WIDE: f32 = 9.0;
const TAPS: i32 = 18;

@vertex
fn vs_blur(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32((vertex << 1u) & 2u), f32(vertex & 2u));
    return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
}

fn blurred(middle: vec4f, step: vec2i) -> vec4f {
    let last = vec2i(textureDimensions(occlusion)) - 1;
    var sum = vec2f(0.0);
    var weights = vec2f(0.0);
    for (var tap = -TAPS; tap <= TAPS; tap++) {
        let at = clamp(vec2i(middle.xy) + tap * step, vec2i(0), last);
        let share = f32(tap) / vec2f(NARROW, WIDE);
        let weight = exp(-0.5 * share * share);
        sum += weight * textureLoad(occlusion, at, 0).rg;
        weights += weight;
    }
    return vec4f(sum / weights, 0.0, 1.0);
}

@fragment
fn fs_blur_across(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return blurred(position, vec2i(1, 0));
}

@fragment
fn fs_blur_down(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return blurred(position, vec2i(0, 1));
}
