// Antialiased lines with a width in pixels, expanded in screen space to a strip of two triangles.
struct LineFragment {
    @builtin(position) position_clip: vec4f,
    @location(0) colour: vec4f,
    // Distance from the line's centre, interpolated in screen space.
    @location(1) @interpolate(linear) across_px: f32,
    // Distance along the line from its start.
    @location(2) @interpolate(linear) along_px: f32,
    @location(3) length_px: f32,
    @location(4) half_width_px: f32,
    @location(5) hidden_share: f32,
}

// Clips `a` to the near plane: if it is in front of the plane (z > w), gives the intersection on the way to `b`.
fn clipped_to_near(a: vec4f, b: vec4f) -> vec4f {
    let inside_a = a.w - a.z;
    let inside_b = b.w - b.z;
    if inside_a >= 0.0 || inside_b <= 0.0 {
        return a;
    }
    return mix(a, b, inside_a / (inside_a - inside_b));
}

// The depth of a point moved towards the eye by the size of `px` pixels at its distance. Otherwise, half of a strip
// that faces the eye would disappear in a tilted surface.
fn depth_nearer_by(position_clip: vec4f, px: f32) -> f32 {
    let from_view = transpose(frame.view_from_world);
    let distance = mix(1.0, position_clip.w, frame.perspective);
    let step_world = from_view[2].xyz * (px * distance / frame.scale_px);
    let nearer = position_clip + frame.clip_from_world * vec4f(step_world, 0.0);
    return min(nearer.z / max(nearer.w, 1e-9), 1.0);
}

// Corner 0 to 3 of the strip, which extends beyond the line's ends by `cap_px`. Colours are linear and premultiplied.
fn widened(
    corner: u32,
    start: vec3f,
    end: vec3f,
    width_px: f32,
    cap_px: f32,
    start_colour: vec4f,
    end_colour: vec4f,
    hidden_share: f32,
) -> LineFragment {
    let start_whole = frame.clip_from_world * vec4f(start, 1.0);
    let end_whole = frame.clip_from_world * vec4f(end, 1.0);
    let start_clip = clipped_to_near(start_whole, end_whole);
    let end_clip = clipped_to_near(end_whole, start_whole);
    let half_size_px = 0.5 * frame.size_px;
    let start_px = start_clip.xy / max(start_clip.w, 1e-9) * half_size_px;
    let end_px = end_clip.xy / max(end_clip.w, 1e-9) * half_size_px;
    let along = end_px - start_px;
    let length_px = length(along);
    let direction = select(vec2f(1.0, 0.0), along / length_px, length_px > 1e-6);
    let at_end = (corner & 1u) == 1u;
    let side = select(-1.0, 1.0, (corner & 2u) == 2u);
    // One more pixel on each side for antialiasing.
    let half_width_px = 0.5 * width_px;
    let reach_px = half_width_px + 1.0;
    let cap_reach_px = select(0.0, cap_px + 1.0, cap_px > 0.0) * select(-1.0, 1.0, at_end);
    let offset_px = vec2f(-direction.y, direction.x) * side * reach_px + direction * cap_reach_px;

    var out: LineFragment;
    var position = select(start_clip, end_clip, at_end);
    let depth = depth_nearer_by(position, 3.0 * reach_px);
    position = vec4f(position.xy + offset_px / half_size_px * position.w, depth * position.w, position.w);
    out.position_clip = position;
    out.colour = select(start_colour, end_colour, at_end);
    out.across_px = side * reach_px;
    out.along_px = select(0.0, length_px, at_end) + cap_reach_px;
    out.length_px = length_px;
    out.half_width_px = half_width_px;
    out.hidden_share = hidden_share;
    return out;
}

// Distance beyond the nearer end; negative between the ends.
fn beyond_px(in: LineFragment) -> f32 {
    return max(-in.along_px, in.along_px - in.length_px);
}

fn coverage(in: LineFragment) -> f32 {
    let away_px = length(vec2f(in.across_px, max(beyond_px(in), 0.0)));
    return clamp(in.half_width_px + 0.5 - away_px, 0.0, 1.0);
}
