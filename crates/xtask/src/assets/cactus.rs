//! The cactus: a ribbed trunk with two arms in a pot and a flower on top, with strongly protruding parts to bend.

use super::limb::Limb;
use super::noise::{fractal, gradient};
use super::solid::Solid;
use super::solid::{ellipsoid, mix, round_cone, smooth_difference, smooth_union, sphere, srgb, step};
use super::vector::{Vec3, v};

/// The cactus's stems.
pub struct Cactus {
    trunk: Limb,
    arms: [Limb; 2],
}

/// Ribs around a stem.
const RIBS: u32 = 10;

impl Cactus {
    /// Places the stems.
    pub fn new() -> Self {
        let trunk = Limb::through(
            &[
                (v(0.0, 0.16, 0.0), 0.095),
                (v(0.0, 0.40, 0.0), 0.118),
                (v(0.0, 0.70, 0.0), 0.115),
                (v(0.0, 0.95, 0.0), 0.090),
            ],
            5,
        );
        let right = Limb::through(
            &[
                (v(0.06, 0.46, 0.0), 0.055),
                (v(0.22, 0.47, 0.02), 0.058),
                (v(0.29, 0.56, 0.03), 0.062),
                (v(0.30, 0.72, 0.03), 0.056),
            ],
            5,
        );
        let left = Limb::through(
            &[
                (v(-0.06, 0.60, 0.0), 0.048),
                (v(-0.19, 0.60, -0.02), 0.050),
                (v(-0.25, 0.67, -0.03), 0.053),
                (v(-0.26, 0.80, -0.03), 0.047),
            ],
            5,
        );
        Self {
            trunk,
            arms: [right, left],
        }
    }

    /// Height of the ribs around the vertical axis through `centre`: 1 on a crest, -1 in a furrow.
    ///
    /// cos(n θ) is the Chebyshev polynomial of cos θ, so no trigonometry is needed.
    fn ribs(p: Vec3, centre: Vec3) -> f64 {
        let q = v(p.x - centre.x, 0.0, p.z - centre.z);
        let cosine = q.normalized().z;
        let (mut before, mut here) = (1.0, cosine);
        for _ in 1..RIBS {
            (before, here) = (here, 2.0 * cosine * here - before);
        }
        here
    }

    fn stems(&self, p: Vec3) -> f64 {
        let crown = step(1.03, 0.97, p.y) * step(0.02, 0.05, v(p.x, 0.0, p.z).length());
        let mut d = self.trunk.distance(p, f64::INFINITY) - 0.008 * Self::ribs(p, Vec3::default()) * crown;
        for arm in &self.arms {
            let tip = arm.knots[arm.knots.len() - 1].0;
            let away = v(p.x - tip.x, 0.0, p.z - tip.z).length();
            let upright =
                step(tip.y - 0.16, tip.y - 0.10, p.y) * step(tip.y + 0.05, tip.y, p.y) * step(0.01, 0.03, away);
            d = smooth_union(
                d,
                arm.distance(p, f64::INFINITY) - 0.005 * Self::ribs(p, tip) * upright,
                0.05,
            );
        }
        d
    }

    fn pot(p: Vec3) -> f64 {
        let across = v(p.x, 0.0, p.z).length();
        let wall = (across - 0.150 - 0.20 * p.y).max(-p.y).max(p.y - 0.20) * 0.95;
        let rim = (across - 0.212).max((p.y - 0.20).abs() - 0.026);
        let pot = smooth_union(wall, rim, 0.012);
        let soil = (across - 0.175).max(0.195 - p.y);
        smooth_difference(pot, soil, 0.012) - 0.006
    }

    fn flower(p: Vec3) -> f64 {
        let middle = v(0.01, 1.045, 0.0);
        let mut d = sphere(p, middle, 0.026);
        for petal in [
            v(0.92, 0.0, 0.38),
            v(-0.08, 0.0, 1.0),
            v(-0.97, 0.0, 0.23),
            v(-0.52, 0.0, -0.85),
            v(0.65, 0.0, -0.76),
        ] {
            let tip = middle + petal * 0.058 + v(0.0, 0.022, 0.0);
            d = smooth_union(d, round_cone(p, middle, 0.014, tip, 0.020), 0.012);
        }
        d
    }
}

impl Solid for Cactus {
    fn distance(&self, p: Vec3) -> f64 {
        let plant = smooth_union(self.stems(p), Self::flower(p), 0.015);
        let d = smooth_union(plant, Self::pot(p), 0.02);
        if d.abs() > 0.05 {
            d
        } else {
            d - 0.0018 * fractal(p * 22.0, 3, 3)
        }
    }

    fn bounds(&self) -> (Vec3, Vec3) {
        (v(-0.34, -0.02, -0.25), v(0.39, 1.12, 0.25))
    }

    fn colour(&self, p: Vec3, normal: Vec3) -> Vec3 {
        let green = mix(
            srgb(0x3f7d4e),
            srgb(0x8cbf6a),
            step(-0.3, 0.9, 0.5 * (Self::ribs(p, Vec3::default()) + normal.y)),
        );
        let mut colour = green * (1.0 + 0.10 * gradient(p * 14.0, 8));
        let clay = srgb(0xc46a45) * (1.0 + 0.08 * gradient(v(p.x * 6.0, p.y * 30.0, p.z * 6.0), 4));
        let soil = step(0.177, 0.168, v(p.x, 0.0, p.z).length()) * step(0.17, 0.18, p.y) * step(0.3, 0.7, normal.y);
        let pot = mix(clay, srgb(0x4d382b), soil);
        colour = mix(pot, colour, step(-0.004, 0.010, Self::pot(p) - self.stems(p)));
        let heart = ellipsoid(p, v(0.01, 1.07, 0.0), v(0.020, 0.016, 0.020));
        let petals = mix(srgb(0xf4c542), srgb(0xe0567e), step(0.0, 0.012, heart));
        mix(petals, colour, step(0.000, 0.008, Self::flower(p)))
    }
}
