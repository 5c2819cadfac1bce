// A line of a width in pixels: widened on the screen to a strip of two triangles, with borders that fade over one pixel.
struct LineFragment {
    @builtin(position) position_clip: vec4f,
    @location(0) colour: vec4f,
    // Distance from the line's middle, interpolated on the screen.
    @location(1) @interpolate(linear) across_px: f32,
    @location(2) half_width_px: f32,
    @location(3) hidden_share: f32,
}

// `a`, or where it lies before the near plane (z > w), the point on the way to `b` that does not.
fn before_the_eye(a: vec4f, b: vec4f) -> vec4f {
    let inside_a = a.w - a.z;
    let inside_b = b.w - b.z;
    if inside_a >= 0.0 || inside_b <= 0.0 {
        return a;
    }
    return mix(a, b, inside_a / (inside_a - inside_b));
}

// The strip's corner 0 to 3. Colours are linear and premultiplied.
fn widened(
    corner: u32,
    start: vec3f,
    end: vec3f,
    width_px: f32,
    start_colour: vec4f,
    end_colour: vec4f,
    hidden_share: f32,
) -> LineFragment {
    let start_whole = frame.clip_from_world * vec4f(start, 1.0);
    let end_whole = frame.clip_from_world * vec4f(end, 1.0);
    let start_clip = before_the_eye(start_whole, end_whole);
    let end_clip = before_the_eye(end_whole, start_whole);
    let half_size_px = 0.5 * frame.size_px;
    let start_px = start_clip.xy / max(start_clip.w, 1e-9) * half_size_px;
    let end_px = end_clip.xy / max(end_clip.w, 1e-9) * half_size_px;
    let along = end_px - start_px;
    let length_px = length(along);
    let direction = select(vec2f(1.0, 0.0), along / length_px, length_px > 1e-6);
    let at_end = (corner & 1u) == 1u;
    let side = select(-1.0, 1.0, (corner & 2u) == 2u);
    // A pixel more on each side for the fading border.
    let half_width_px = 0.5 * width_px;
    let reach_px = half_width_px + 1.0;
    let offset_px = vec2f(-direction.y, direction.x) * side * reach_px;

    var out: LineFragment;
    var position = select(start_clip, end_clip, at_end);
    position = vec4f(position.xy + offset_px / half_size_px * position.w, position.z * 1.0015, position.w);
    out.position_clip = position;
    out.colour = select(start_colour, end_colour, at_end);
    out.across_px = side * reach_px;
    out.half_width_px = half_width_px;
    out.hidden_share = hidden_share;
    return out;
}

fn coverage(in: LineFragment) -> f32 {
    return clamp(in.half_width_px + 0.5 - abs(in.across_px), 0.0, 1.0);
}
