//! The face: the head of a man with a high forehead, whose expressions ([`super::expressions`]) have wrinkles.
//!
//! The head is about one unit high, is centred on the origin and looks to +z. Everything except hair and skin is
//! modelled at x > 0 and mirrored.

use super::noise::{fractal, gradient};
use super::solid::Solid;
use super::solid::{chain, ellipsoid, mix, round_cone, smooth_difference, smooth_union, sphere, srgb, step};
use super::vector::{Vec3, v};

/// The face has nothing to precompute.
pub struct Face;

const EYE: Vec3 = v(0.142, 0.030, 0.268);
const EYE_RADIUS: f64 = 0.086;
/// The middle and the semi-axes of the cranium.
pub const CRANIUM: (Vec3, Vec3) = (v(0.0, 0.13, -0.05), v(0.37, 0.40, 0.44));

/// The smooth normal of the forehead and the cheeks at `p`.
pub fn outwards(p: Vec3) -> Vec3 {
    let (middle, radii) = CRANIUM;
    let flat = v(p.x, p.y.max(-0.05), p.z) - middle;
    flat.over(radii).over(radii).normalized()
}

/// Skull, jaw, cheeks and brows, without the features on them.
fn head(q: Vec3) -> f64 {
    let (middle, radii) = CRANIUM;
    let mut d = ellipsoid(q, middle, radii);
    d = smooth_union(d, ellipsoid(q, v(0.0, -0.13, 0.10), v(0.270, 0.36, 0.285)), 0.14);
    d = smooth_union(
        d,
        round_cone(q, v(0.185, -0.25, 0.03), 0.10, v(0.07, -0.42, 0.23), 0.085),
        0.10,
    );
    d = smooth_union(d, ellipsoid(q, v(0.0, -0.440, 0.285), v(0.090, 0.065, 0.080)), 0.07);
    d = smooth_union(d, ellipsoid(q, v(0.190, -0.095, 0.255), v(0.095, 0.090, 0.085)), 0.09);
    let brow = chain(
        q,
        &[
            (v(0.0, 0.140, 0.345), 0.040),
            (v(0.12, 0.150, 0.335), 0.050),
            (v(0.235, 0.115, 0.235), 0.042),
        ],
    );
    d = smooth_union(d, brow, 0.07);
    let socket = ellipsoid(q, v(0.140, 0.035, 0.410), v(0.100, 0.058, 0.080));
    d = smooth_difference(d, socket, 0.06);
    let neck = round_cone(q, v(0.0, -0.28, -0.08), 0.20, v(0.0, -0.80, -0.13), 0.235);
    smooth_union(d, neck, 0.10)
}

fn nose(q: Vec3) -> f64 {
    let bridge = round_cone(q, v(0.0, 0.085, 0.352), 0.032, v(0.0, -0.105, 0.440), 0.044);
    let tip = sphere(q, v(0.0, -0.122, 0.445), 0.053);
    let wing = ellipsoid(q, v(0.052, -0.142, 0.400), v(0.036, 0.034, 0.046));
    let nose = smooth_union(smooth_union(bridge, tip, 0.05), wing, 0.025);
    smooth_difference(
        nose,
        ellipsoid(q, v(0.029, -0.182, 0.418), v(0.017, 0.014, 0.024)),
        0.014,
    )
}

/// Height of the line between the lips.
fn seam(x: f64) -> f64 {
    -0.288 - 0.25 * x * x + 0.9 * (x - 0.085).max(0.0) * (x - 0.085).max(0.0)
}

#[expect(clippy::approx_constant, reason = "a depth that was measured by eye, not 1/π")]
fn upper_lip(q: Vec3) -> f64 {
    let arc = [
        (v(0.0, -0.272, 0.378), 0.020),
        (v(0.032, -0.266, 0.374), 0.024),
        (v(0.112, -0.288, 0.318), 0.013),
    ];
    chain(q, &arc)
}

fn lower_lip(q: Vec3) -> f64 {
    let arc = [
        (v(0.0, -0.316, 0.372), 0.028),
        (v(0.055, -0.311, 0.355), 0.025),
        (v(0.112, -0.291, 0.316), 0.012),
    ];
    chain(q, &arc)
}

/// Upper and lower lid: a shell around the eye, cut open to the front.
fn lids(q: Vec3) -> f64 {
    let out = q - EYE;
    let upper = -out.dot(v(-0.05, 0.90, -0.42)) - 0.010;
    let lower = out.dot(v(0.05, 0.86, 0.50)) - 0.016;
    smooth_difference(out.length() - EYE_RADIUS - 0.020, -upper.min(lower), 0.005)
}

fn ear(q: Vec3) -> f64 {
    // The ear sticks out towards the back.
    let lean = v(q.x - 0.30 * (-0.03 - q.z), q.y - 0.10 * (q.z + 0.05), q.z);
    let shell = ellipsoid(lean, v(0.372, -0.005, -0.055), v(0.034, 0.112, 0.072));
    let bowl = ellipsoid(lean, v(0.405, 0.005, -0.040), v(0.030, 0.078, 0.045));
    smooth_difference(shell, bowl, 0.02) * 0.9
}

/// The area of the hair: 1 within, 0 on the skin.
fn hair(p: Vec3) -> f64 {
    let q = p.mirrored();
    let front = 0.445 - 0.9 * (q.x - 0.13).max(0.0) * (0.30 - q.x).max(0.0) * 10.0 * (q.x - 0.13).max(0.0);
    let side = front + (0.02 - front) * step(0.20, 0.06, q.z);
    let line = side + (-0.30 - side) * step(-0.10, -0.32, q.z);
    let ragged = line + 0.02 * gradient(p * 22.0, 51);
    step(ragged - 0.012, ragged + 0.012, q.y) * step(0.030, 0.045, ear(q))
}

/// The area of the eyebrows.
fn eyebrow(p: Vec3) -> f64 {
    let q = p.mirrored();
    let along = ((q.x - 0.045) / 0.215).clamp(0.0, 1.0);
    let middle = 0.148 + 0.105 * along * (1.0 - along) + 0.010 * along;
    let width = 0.025 * (1.0 - 0.65 * along);
    let ragged = width * (1.0 + 0.35 * gradient(p * 45.0, 61));
    step(ragged, ragged * 0.55, (q.y - middle).abs())
        * step(0.036, 0.050, q.x)
        * step(0.268, 0.250, q.x)
        * step(0.10, 0.16, q.z)
}

impl Face {
    fn smooth(p: Vec3) -> f64 {
        let q = p.mirrored();
        let mut d = smooth_union(head(q), nose(q), 0.045);
        d = smooth_union(d, ellipsoid(q, v(0.0, -0.290, 0.270), v(0.150, 0.085, 0.100)), 0.07);
        d = smooth_union(d, upper_lip(q), 0.018);
        d = smooth_union(d, lower_lip(q), 0.022);
        let groove = step(0.020, 0.002, (q.y - seam(q.x)).abs()) * step(0.126, 0.104, q.x) * step(0.20, 0.26, q.z);
        d += 0.017 * groove;
        d = smooth_union(d, ear(q), 0.03);
        d = smooth_union(d, sphere(q, EYE, EYE_RADIUS), 0.003);
        d = smooth_union(d, lids(q), 0.007);
        smooth_difference(d, p.y + 0.62, 0.03)
    }
}

impl Solid for Face {
    fn distance(&self, p: Vec3) -> f64 {
        let d = Self::smooth(p);
        if d.abs() > 0.06 {
            return d;
        }
        let locks = 0.014 + 0.006 * fractal(v(p.x * 26.0, p.y * 9.0, p.z * 9.0), 2, 17);
        d - locks * hair(p) - 0.007 * eyebrow(p)
    }

    fn bounds(&self) -> (Vec3, Vec3) {
        (v(-0.45, -0.66, -0.54), v(0.45, 0.58, 0.58))
    }

    fn colour(&self, p: Vec3, _: Vec3) -> Vec3 {
        let q = p.mirrored();
        if (q - EYE).length() < EYE_RADIUS + 0.0045 && lids(q) > 0.0015 {
            return eye_colour(q);
        }
        let mut skin = srgb(0xdba888) * (1.0 + 0.05 * gradient(p * 9.0, 12));
        let blush = step(0.13, 0.03, (q - v(0.185, -0.115, 0.32)).length());
        skin = mix(skin, srgb(0xcf7f6c), 0.55 * blush);
        skin = mix(
            skin,
            srgb(0xcb7767),
            0.5 * step(0.085, 0.03, (q - v(0.0, -0.13, 0.485)).length()),
        );
        skin = mix(
            skin,
            srgb(0xc98672),
            0.6 * step(0.03, 0.0, ear(q)) * step(0.30, 0.34, q.x),
        );
        let lips = step(0.010, 0.002, upper_lip(q).min(lower_lip(q))) * step(0.124, 0.108, q.x);
        skin = mix(skin, srgb(0xb4645c), 0.85 * lips);
        let groove = step(0.010, 0.002, (q.y - seam(q.x)).abs()) * step(0.122, 0.105, q.x) * step(0.25, 0.30, q.z);
        skin = mix(skin, srgb(0x6d3733), 0.8 * groove);
        skin = mix(
            skin,
            srgb(0x7d4a40),
            step(0.022, 0.010, (q - v(0.029, -0.182, 0.422)).length()),
        );
        let rim = step(0.004, -0.004, lids(q)) * step(EYE_RADIUS + 0.012, EYE_RADIUS + 0.005, (q - EYE).length());
        skin = mix(skin, srgb(0x7e5145), 0.8 * rim);
        let grey = srgb(0x8d8681) * (1.0 + 0.16 * gradient(v(p.x * 50.0, p.y * 16.0, p.z * 16.0), 23));
        skin = mix(skin, grey, hair(p));
        mix(skin, srgb(0x5d5048), eyebrow(p))
    }

    fn scanner_noise(&self, _: usize, _: Vec3) -> f64 {
        0.0
    }
}

/// White, iris and pupil.
fn eye_colour(q: Vec3) -> Vec3 {
    let out = (q - EYE).normalized();
    let gaze = v(-0.03, 0.02, 1.0).normalized();
    let across = (out - gaze).length();
    let iris = mix(srgb(0x2f5a74), srgb(0x7fb0c4), step(0.10, 0.36, across));
    let mut colour = mix(iris, srgb(0xf4efe8), step(0.38, 0.46, across));
    colour = mix(srgb(0x14100f), colour, step(0.15, 0.22, across));
    let glint = (out - (gaze + v(-0.16, 0.20, 0.0)).normalized()).length();
    mix(srgb(0xffffff), colour, step(0.06, 0.11, glint))
}

/// The face in a space in which its front is larger: inverted in a sphere around a point in front of it, and mirrored,
/// so that it looks to +z again. An inversion keeps angles, so equal triangles there are well-shaped ones here, about
/// three times as long at the nape as on the face.
pub struct Magnified;

/// The centre of the sphere, and its squared radius.
const INVERSION: (Vec3, f64) = (v(0.0, 0.06, 1.35), 1.4);

/// The point of the face for one of the magnified space, and back.
pub fn inverted(p: Vec3) -> Vec3 {
    let (centre, square) = INVERSION;
    let from = p - centre;
    let image = from * (square / from.dot(from));
    centre + v(image.x, image.y, -image.z)
}

impl Solid for Magnified {
    fn distance(&self, p: Vec3) -> f64 {
        let (centre, square) = INVERSION;
        let from = p - centre;
        Face.distance(inverted(p)) * (from.dot(from) / square)
    }

    fn bounds(&self) -> (Vec3, Vec3) {
        (v(-0.58, -0.72, 1.98), v(0.58, 0.82, 3.15))
    }

    fn colour(&self, p: Vec3, normal: Vec3) -> Vec3 {
        Face.colour(inverted(p), normal)
    }

    fn scanner_noise(&self, _: usize, _: Vec3) -> f64 {
        0.0
    }
}
