// What all of a frame's shaders know: `FrameUniform` in crates/render/src/frame/uniforms.rs.
struct Frame {
    clip_from_world: mat4x4f,
    view_from_world: mat4x4f,
    // sRGB, 0 to 1.
    background_top: vec4f,
    background_bottom: vec4f,
    size_px: vec2f,
    // Where the picture's lower border is on the background, and how much of it the picture shows: 0 and 1, but for
    // a tile of a larger picture.
    background_span: vec2f,
    // How much of the clay region colours replace, 0 to 1.
    region_share: f32,
    // Pixels that one world unit covers at distance 1 (perspective) or anywhere (parallel).
    scale_px: f32,
    // 1 in perspective, 0 in a parallel view.
    perspective: f32,
    // 1 when faces are flat, 0 when normals are interpolated.
    flatness: f32,
    // Pixels of the picture that marks take for a point.
    pixels_per_point: f32,
    padding: f32,
    padding_to_16: vec2f,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// The unit vector towards the eye from a point of view space.
fn direction_to_eye(position_view: vec3f) -> vec3f {
    return normalize(mix(vec3f(0.0, 0.0, 1.0), -position_view, frame.perspective));
}
