// What all of a frame's shaders know: `FrameUniform` in crates/render/src/uniforms.rs.
struct Frame {
    clip_from_world: mat4x4f,
    view_from_world: mat4x4f,
    // (position, 1) in perspective, (direction towards the eye, 0) in a parallel view.
    eye: vec4f,
    // sRGB, 0 to 1.
    background_top: vec4f,
    background_bottom: vec4f,
    size_px: vec2f,
    // How much of the clay region colours replace, 0 to 1.
    region_share: f32,
    // Pixels that one world unit covers at distance 1 (perspective) or anywhere (parallel).
    scale_px: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
