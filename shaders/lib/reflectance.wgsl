// How a surface of glTF's metallic-roughness model answers light (glTF 2.0, appendix B).

// The key lamp, fixed to the eye, in view space.
const KEY: vec3f = vec3f(-0.503, 0.647, 0.573);
const KEY_COLOUR: vec3f = vec3f(1.55, 1.48, 1.38);

struct Side {
    // What matt scattering multiplies light by.
    albedo: vec3f,
    // What is mirrored head-on.
    f0: vec3f,
    roughness: f32,
    // Cosine between normal and eye.
    facing: f32,
    mirrored_towards: vec3f,
}

fn side_of(base: vec3f, metallic: f32, roughness: f32, n: vec3f, to_eye: vec3f) -> Side {
    var out: Side;
    out.albedo = base * (1.0 - metallic);
    out.f0 = mix(vec3f(0.04), base, metallic);
    // A perfect mirror of a lamp smaller than a pixel would be invisible or a firefly.
    out.roughness = clamp(roughness, 0.045, 1.0);
    out.facing = clamp(dot(n, to_eye), 1e-3, 1.0);
    out.mirrored_towards = 2.0 * dot(n, to_eye) * n - to_eye;
    return out;
}

// Share of light from all around that is mirrored, as a factor of f0 and an addition: the fit of Karis (2014).
fn mirrored_share(roughness: f32, facing: f32) -> vec2f {
    let r = roughness * vec4f(-1.0, -0.0275, -0.572, 0.022) + vec4f(1.0, 0.0425, 1.04, -0.04);
    let a = min(r.x * r.x, exp2(-9.28 * facing)) * r.x + r.y;
    return vec2f(-1.04, 1.04) * a + r.zw;
}

// Light from all around. What rough metal loses by counting one bounce is given back (Fdez-Agüera 2019).
fn ambient_light(side: Side, mirror: vec3f, matt: vec3f, ambient_share: f32) -> vec3f {
    let share = mirrored_share(side.roughness, side.facing);
    let once = side.f0 * share.x + share.y;
    let lost = 1.0 - (share.x + share.y);
    let mean = side.f0 + (1.0 - side.f0) / 21.0;
    let again = lost * once * mean / (1.0 - mean * lost);
    let scattered = side.albedo * (1.0 - once - again);
    // Occlusion hides mirrored light, too, and less so where the surface is smooth (Lagarde 2014).
    let visible = clamp(
        pow(side.facing + ambient_share, exp2(-16.0 * side.roughness - 1.0)) - 1.0 + ambient_share,
        0.0,
        1.0,
    );
    return once * mirror * visible + (scattered + again) * matt * ambient_share;
}

// Light of the key lamp: Trowbridge-Reitz with Smith's masking, height-correlated (Heitz 2014), and Lambert.
fn lamp_light(side: Side, n: vec3f, to_eye: vec3f) -> vec3f {
    let lit = max(dot(n, KEY), 0.0);
    let half_way = normalize(KEY + to_eye);
    let towards = clamp(dot(n, half_way), 0.0, 1.0);
    let across = clamp(dot(to_eye, half_way), 0.0, 1.0);
    let a = side.roughness * side.roughness;
    let a_squared = a * a;
    let spread = towards * towards * (a_squared - 1.0) + 1.0;
    let facets = a_squared / (3.14159265 * spread * spread);
    let masking = lit * sqrt(side.facing * side.facing * (1.0 - a_squared) + a_squared)
        + side.facing * sqrt(lit * lit * (1.0 - a_squared) + a_squared);
    let fresnel = side.f0 + (1.0 - side.f0) * pow(1.0 - across, 5.0);
    let mirrored = fresnel * (facets * 0.5 / max(masking, 1e-5));
    return (side.albedo * (1.0 - fresnel) / 3.14159265 + mirrored) * lit * KEY_COLOUR;
}
