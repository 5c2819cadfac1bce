// sRGB to linear light, exact (IEC 61966-2-1).
fn linear_from_srgb(encoded: vec3f) -> vec3f {
    let low = encoded / 12.92;
    let high = pow((encoded + 0.055) / 1.055, vec3f(2.4));
    return select(high, low, encoded <= vec3f(0.04045));
}

// sRGB to linear light within 0.005, in three multiplications, for vertex colours.
fn linear_from_srgb_fast(encoded: vec3f) -> vec3f {
    return encoded * (encoded * (encoded * 0.305306011 + 0.682171111) + 0.012522878);
}

// An sRGB colour with straight alpha as premultiplied linear light.
fn premultiplied_from_srgb(encoded: vec4f, alpha_share: f32) -> vec4f {
    let alpha = encoded.a * alpha_share;
    return vec4f(linear_from_srgb(encoded.rgb) * alpha, alpha);
}
