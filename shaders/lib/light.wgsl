// The lamps, fixed to the eye as in a sculptor's studio: a warm key from the upper left, a cool fill from the right,
// a rim from behind, and a soft sky. All directions are in view space (x right, y up, z towards the eye).
const KEY: vec3f = vec3f(-0.503, 0.647, 0.573);
const FILL: vec3f = vec3f(0.874, -0.175, 0.453);
const RIM: vec3f = vec3f(0.391, 0.521, -0.759);

const KEY_COLOUR: vec3f = vec3f(1.30, 1.22, 1.12);
const FILL_COLOUR: vec3f = vec3f(0.110, 0.128, 0.165);
const RIM_COLOUR: vec3f = vec3f(1.05, 1.15, 1.30);
const SKY_COLOUR: vec3f = vec3f(0.150, 0.163, 0.185);
const GROUND_COLOUR: vec3f = vec3f(0.058, 0.050, 0.044);

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

// Lamps on a surface of unit normal `n`, seen along unit vector `to_eye`.
fn light(n: vec3f, to_eye: vec3f) -> Light {
    var out: Light;
    out.grazing = 1.0 - max(dot(n, to_eye), 0.0);
    // The key reaches around the corner and fades out without a crease, as a large soft lamp does.
    let reach = max((dot(n, KEY) + 0.35) / 1.35, 0.0);
    let key = reach * reach;
    let fill = max((dot(n, FILL) + 0.30) / 1.30, 0.0);
    let sky = mix(GROUND_COLOUR, SKY_COLOUR, 0.5 + 0.5 * n.y);
    let edge = out.grazing * out.grazing * out.grazing;
    let rim = edge * max(dot(n, RIM) + 0.45, 0.0);
    out.diffuse = key * KEY_COLOUR + fill * FILL_COLOUR + sky + rim * RIM_COLOUR;
    // Blinn-Phong with exponent 32, by squaring.
    let half_way = max(dot(n, normalize(KEY + to_eye)), 0.0);
    let squared = half_way * half_way;
    let eighth = squared * squared * squared * squared;
    let glint = eighth * eighth * eighth * eighth;
    out.specular = (glint * key) * KEY_COLOUR;
    return out;
}

// Bright light bends softly towards white instead of clipping, as film does; below the knee nothing changes.
fn rolled_off(light: vec3f) -> vec3f {
    const KNEE: f32 = 0.50;
    let over = max(light - KNEE, vec3f(0.0)) / (1.0 - KNEE);
    return min(light, vec3f(KNEE)) + (1.0 - KNEE) * over / (1.0 + over);
}
