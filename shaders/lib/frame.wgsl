// The uniform of all shaders of a frame: `FrameUniform` in crates/render/src/frame/uniforms.rs.
struct Frame {
    clip_from_world: mat4x4f,
    view_from_world: mat4x4f,
    // sRGB, 0 to 1.
    background_top: vec4f,
    background_bottom: vec4f,
    size_px: vec2f,
    // The part of the background that this picture shows: its start from the bottom and its length. 0 and 1 unless the
    // picture is a tile of a larger one.
    background_span: vec2f,
    // The share of the shading's colour that the region colours replace, 0 to 1.
    region_share: f32,
    // Pixels per world unit at distance 1 (perspective) or at any distance (orthographic).
    scale_px: f32,
    // 1 in perspective, 0 in an orthographic view.
    perspective: f32,
    // 1 for flat shading, 0 for interpolated normals.
    flatness: f32,
    // Pixels per point, for the widths of lines on surfaces.
    pixels_per_point: f32,
    padding: f32,
    padding_to_16: vec2f,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// The unit vector towards the eye from a point in view space.
fn direction_to_eye(position_view: vec3f) -> vec3f {
    return normalize(mix(vec3f(0.0, 0.0, 1.0), -position_view, frame.perspective));
}
