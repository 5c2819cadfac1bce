// The lamps, fixed to the eye as in a sculptor's studio: a warm key from the upper left, a cool fill from the right,
// a rim from behind, and a soft sky. All directions are in view space (x right, y up, z towards the eye).
const KEY: vec3f = vec3f(-0.452, 0.633, 0.629);
const FILL: vec3f = vec3f(0.848, -0.053, 0.528);
const RIM: vec3f = vec3f(0.391, 0.521, -0.759);

const KEY_COLOUR: vec3f = vec3f(1.06, 1.0, 0.93);
const FILL_COLOUR: vec3f = vec3f(0.17, 0.19, 0.23);
const RIM_COLOUR: vec3f = vec3f(0.30, 0.32, 0.36);
const SKY_COLOUR: vec3f = vec3f(0.250, 0.262, 0.285);
const GROUND_COLOUR: vec3f = vec3f(0.105, 0.098, 0.090);

struct Light {
    // Multiplies the albedo.
    diffuse: vec3f,
    // To be multiplied by a specular strength and added.
    specular: vec3f,
    // 0 where the surface faces the eye, 1 at its contour.
    grazing: f32,
}

// The normal seen from the eye: turned to the side that is seen, and where interpolation still turns it away from
// the eye, mirrored into the visible half, which is continuous at the contour where a sign flip is not.
fn seen_normal(normal: vec3f, to_eye: vec3f, is_front: bool) -> vec3f {
    let length_squared = dot(normal, normal);
    var n = select(to_eye, normal * inverseSqrt(length_squared), length_squared > 1e-20);
    n = select(-n, n, is_front);
    let facing = dot(n, to_eye);
    return select(n - 2.0 * facing * to_eye, n, facing >= 0.0);
}

// Lamps on a surface of unit normal `n`, seen along unit vector `to_eye`; `shininess` is Blinn-Phong's exponent.
fn light(n: vec3f, to_eye: vec3f, shininess: f32) -> Light {
    var out: Light;
    let facing = max(dot(n, to_eye), 0.0);
    out.grazing = 1.0 - facing;
    // The key reaches a little around the corner, as a large soft lamp does.
    let key = max((dot(n, KEY) + 0.12) / 1.12, 0.0);
    let fill = max((dot(n, FILL) + 0.25) / 1.25, 0.0);
    let sky = mix(GROUND_COLOUR, SKY_COLOUR, 0.5 + 0.5 * n.y);
    out.diffuse = key * KEY_COLOUR + fill * FILL_COLOUR + sky;
    let half_way = normalize(KEY + to_eye);
    let glint = pow(max(dot(n, half_way), 0.0), shininess) * key;
    let edge = out.grazing * out.grazing * out.grazing;
    let rim = edge * max(dot(n, RIM) + 0.45, 0.0);
    out.specular = glint * KEY_COLOUR;
    out.diffuse += rim * RIM_COLOUR * 4.0;
    return out;
}
