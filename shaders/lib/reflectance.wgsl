// The BRDF of glTF's metallic-roughness model (glTF 2.0, appendix B).

// Direction and colour of the key light, in view space.
const KEY_DIRECTION: vec3f = vec3f(-0.503, 0.647, 0.573);
const KEY_COLOUR: vec3f = vec3f(1.55, 1.48, 1.38);

struct ShadingPoint {
    // Diffuse albedo.
    albedo: vec3f,
    // Reflectance at normal incidence.
    f0: vec3f,
    roughness: f32,
    n_dot_v: f32,
    reflected: vec3f,
}

fn shading_point(base: vec3f, metallic: f32, roughness: f32, n: vec3f, to_eye: vec3f) -> ShadingPoint {
    var out: ShadingPoint;
    out.albedo = base * (1.0 - metallic);
    out.f0 = mix(vec3f(0.04), base, metallic);
    // The highlight of a perfect mirror would be smaller than a pixel: invisible, or a firefly.
    out.roughness = clamp(roughness, 0.045, 1.0);
    out.n_dot_v = clamp(dot(n, to_eye), 1e-3, 1.0);
    out.reflected = 2.0 * dot(n, to_eye) * n - to_eye;
    return out;
}

// Scale and bias of f0 for specular light from the environment: the analytic fit of [Kar14].
fn environment_brdf(roughness: f32, n_dot_v: f32) -> vec2f {
    let r = roughness * vec4f(-1.0, -0.0275, -0.572, 0.022) + vec4f(1.0, 0.0425, 1.04, -0.04);
    let a = min(r.x * r.x, exp2(-9.28 * n_dot_v)) * r.x + r.y;
    return vec2f(-1.04, 1.04) * a + r.zw;
}

// Image-based light, with the energy that single scattering loses on rough metal added back [Fde19].
fn environment_light(point: ShadingPoint, prefiltered: vec3f, irradiance: vec3f, ambient_share: f32) -> vec3f {
    let scale_bias = environment_brdf(point.roughness, point.n_dot_v);
    let single = point.f0 * scale_bias.x + scale_bias.y;
    let lost = 1.0 - (scale_bias.x + scale_bias.y);
    let mean_fresnel = point.f0 + (1.0 - point.f0) / 21.0;
    let multiple = lost * single * mean_fresnel / (1.0 - mean_fresnel * lost);
    let diffuse = point.albedo * (1.0 - single - multiple);
    // Specular occlusion: ambient occlusion hides reflections too, but less on smooth surfaces [LR14].
    let visible = clamp(
        pow(point.n_dot_v + ambient_share, exp2(-16.0 * point.roughness - 1.0)) - 1.0 + ambient_share,
        0.0,
        1.0,
    );
    return single * prefiltered * visible + (diffuse + multiple) * irradiance * ambient_share;
}

// The key light: Lambert diffuse, and GGX (Trowbridge-Reitz) specular with height-correlated Smith masking [Hei14].
fn key_light(point: ShadingPoint, n: vec3f, to_eye: vec3f) -> vec3f {
    let n_dot_l = max(dot(n, KEY_DIRECTION), 0.0);
    let half_vector = normalize(KEY_DIRECTION + to_eye);
    let n_dot_h = clamp(dot(n, half_vector), 0.0, 1.0);
    let v_dot_h = clamp(dot(to_eye, half_vector), 0.0, 1.0);
    let a = point.roughness * point.roughness;
    let a_squared = a * a;
    let denominator = n_dot_h * n_dot_h * (a_squared - 1.0) + 1.0;
    let distribution = a_squared / (3.14159265 * denominator * denominator);
    let masking = n_dot_l * sqrt(point.n_dot_v * point.n_dot_v * (1.0 - a_squared) + a_squared)
        + point.n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - a_squared) + a_squared);
    let fresnel = point.f0 + (1.0 - point.f0) * pow(1.0 - v_dot_h, 5.0);
    let specular = fresnel * (distribution * 0.5 / max(masking, 1e-5));
    return (point.albedo * (1.0 - fresnel) / 3.14159265 + specular) * n_dot_l * KEY_COLOUR;
}
