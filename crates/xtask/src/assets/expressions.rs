//! The face's expressions: the displacement of each point, and the wrinkles that fold the skin across the direction of
//! compression.

use super::face::outwards;
use super::noise::gradient;
use super::solid::step;
use super::vector::{Vec3, v};

/// An expression: its name, and the displacements of the face.
pub struct Expression {
    /// The morph target's name.
    pub name: &'static str,
    /// The displacement of a point of the face.
    pub displacement: fn(Vec3) -> Vec3,
}

/// Every expression of the face.
pub const EXPRESSIONS: [Expression; 3] = [
    Expression {
        name: "Brows raised",
        displacement: brows_raised,
    },
    Expression {
        name: "Frown",
        displacement: frown,
    },
    Expression {
        name: "Smile",
        displacement: smile,
    },
];

/// Both brows rise, and the forehead folds into furrows across.
fn brows_raised(p: Vec3) -> Vec3 {
    let x = p.x.abs();
    let out = outwards(p);
    let up = (v(0.0, 1.0, 0.0) - out * out.y).normalized();
    let lifted = step(0.075, 0.135, p.y) * step(0.50, 0.17, p.y) * step(0.36, 0.24, x) * step(0.02, 0.14, p.z);
    // Furrows sink at their ends, and no two are equal.
    let height = p.y + 0.30 * x * x + 0.008 * gradient(v(p.x * 7.0, p.y * 7.0, 0.0), 5);
    let place = (height - 0.212) / 0.053;
    let which = place.floor();
    let ends = 0.21 + 0.05 * gradient(v(which * 3.7, if p.x < 0.0 { 0.3 } else { 1.7 }, 0.5), 8);
    let folded =
        step(-0.35, 0.25, place) * step(4.35, 3.75, place) * step(ends + 0.03, ends - 0.08, x) * step(0.1, 0.2, p.z);
    up * (0.080 * lifted) + out * (0.020 * folded * (fold(place) - 0.45))
}

/// The brows move down and together, and upright furrows form between them.
fn frown(p: Vec3) -> Vec3 {
    let x = p.x.abs();
    let out = outwards(p);
    let off = v(x - 0.115, (p.y - 0.160) * 0.9, 0.0).length();
    let moved = step(0.175, 0.055, off) * step(0.02, 0.14, p.z) * step(0.055, 0.105, p.y + 0.25 * x);
    let inwards = -(p.x / 0.07).clamp(-1.0, 1.0);
    let between = step(0.085, 0.055, x) * step(0.02, 0.14, p.z) * step(0.065, 0.105, p.y) * step(0.275, 0.205, p.y);
    let lean = 0.016 + 0.10 * (p.y - 0.08).max(0.0) + 0.004 * gradient(p * 11.0, 21);
    let furrow = 0.019 * groove((x - lean) / 0.017);
    let puff = 0.007 * step(0.075, 0.03, x);
    let root = 0.012 * groove((p.y - 0.082 - 0.9 * x * x) / 0.015) * step(0.065, 0.035, x) * step(0.28, 0.34, p.z);
    v(inwards * 0.036, -0.045, 0.006) * moved + out * (between * (puff - furrow) - root)
}

/// The corners of the mouth move out and up, a fold runs from the nose past the mouth, and the eyes' outer corners
/// crinkle.
fn smile(p: Vec3) -> Vec3 {
    let x = p.x.abs();
    let side = (p.x / 0.06).clamp(-1.0, 1.0);
    let out = v(p.x * 1.6, (p.y + 0.1) * 0.4, p.z + 0.05).normalized();
    let front = step(0.02, 0.14, p.z);
    let near = step(0.170, 0.030, (p.y + 0.290).abs()) * step(0.310, 0.130, x) * front;
    let (widened, raised) = (step(0.0, 0.120, x) * near, step(0.0, 0.200, x) * near);
    let cheek = step(0.120, 0.010, v(x - 0.175, p.y + 0.125, 0.0).length()) * front;
    // The fold's course: its distance from the middle at this height.
    let below = -0.125 - p.y;
    let course = 0.080 + 0.62 * below - 0.95 * below * below;
    let beyond = (x - course) * 0.85;
    let along = step(-0.015, 0.035, below) * step(0.255, 0.165, below) * front;
    let crease = 0.016 * groove(beyond / 0.018) - 0.020 * step(0.0, 0.024, beyond) * step(0.115, 0.035, beyond);
    // Crow's feet spread from a point inside the corner.
    let (across, rise) = (x - 0.185, p.y - 0.028);
    let fan = rise / across.max(0.02);
    let feet =
        step(0.045, 0.075, across) * step(0.150, 0.105, across) * step(1.15, 0.95, fan.abs()) * step(0.0, 0.06, p.z);
    let crinkle = 0.011 * (fold((fan + 1.2) / 0.6 + 0.06 * gradient(p * 13.0, 34)) - 0.5);
    v(side * 0.050 * widened, 0.078 * raised, -0.034 * raised)
        + v(side * 0.004, 0.030, 0.008) * cheek
        + out * (0.012 * cheek - along * crease + feet * crinkle)
}

/// A row of folds, one per unit: round ridges of the height 1 with sharp furrows between them at whole numbers.
fn fold(place: f64) -> f64 {
    let from_furrow = 1.0 - (2.0 * (place - place.floor()) - 1.0).abs();
    from_furrow * (2.0 - from_furrow)
}

/// One furrow of the depth 1 at 0, which ends at −1 and 1.
fn groove(place: f64) -> f64 {
    let inside = (1.0 - place.abs()).max(0.0);
    inside * inside * (3.0 - 2.0 * inside)
}
