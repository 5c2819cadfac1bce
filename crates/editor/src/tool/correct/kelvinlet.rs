//! A grab that keeps the volume: the response of an incompressible elastic solid to a force [DGJ17].
//!
//! With r from the force's place, r_ε = √(r² + ε²) and a solid that can't be compressed (ν = 1/2, so b = a/2), the
//! regularised Kelvinlet of their equation 6 is
//!
//! u_ε(r) = [(a − b)/r_ε I + b/r_ε³ r rᵀ + a/2 ε²/r_ε³ I] f.
//!
//! A combination of three of them with neighbouring radii falls off with the fifth power of the distance (their section
//! 5), so that a grab stays local.

use glam::{DMat3, DVec3};

/// The ratio of each radius to the last one.
const STEP: f64 = 1.1;

/// A grab at a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kelvinlet {
    centre: DVec3,
    radii: [f64; 3],
    weights: [f64; 3],
    /// The factor with which the place itself follows the pointer.
    scale: f64,
}

impl Kelvinlet {
    /// A grab of about the width `radius` (above 0).
    pub fn new(centre: DVec3, radius: f64) -> Self {
        let radii = [radius, STEP * radius, STEP * STEP * radius];
        let [first, second, third] = radii.map(|radius| radius * radius);
        let weights = [
            1.0,
            -(third - first) / (third - second),
            (second - first) / (third - second),
        ];
        let mut own = Self {
            centre,
            radii,
            weights,
            scale: 1.0,
        };
        own.scale = own.at(centre).x_axis.x.recip();
        own
    }

    /// The matrix from the displacement of the place to that of `point`.
    pub fn at(&self, point: DVec3) -> DMat3 {
        let r = point - self.centre;
        let outer = DMat3::from_cols(r * r.x, r * r.y, r * r.z);
        let mut sum = DMat3::ZERO;
        for (radius, weight) in self.radii.iter().zip(self.weights) {
            let square = radius * radius;
            let far = (r.length_squared() + square).sqrt();
            let cube = far * far * far;
            // a = 1, b = 1/2.
            let along = 0.5 / far + 0.5 * square / cube;
            sum += (DMat3::from_diagonal(DVec3::splat(along)) + outer * (0.5 / cube)) * weight;
        }
        sum * self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CENTRE: DVec3 = DVec3::new(0.3, -0.2, 0.5);
    const WAY: DVec3 = DVec3::new(0.2, 0.5, -0.1);

    fn moved(point: DVec3) -> DVec3 {
        Kelvinlet::new(CENTRE, 0.4).at(point) * WAY
    }

    #[test]
    fn the_place_goes_all_the_way_and_what_is_far_stays() {
        assert!(moved(CENTRE).distance(WAY) < 1e-12);
        let at = |distance: f64| moved(CENTRE + DVec3::new(0.6, 0.0, 0.8) * distance).length();
        assert!(at(0.2) < WAY.length() && at(0.4) < at(0.2));
        // The fifth power: at twice the distance, a thirty-second of the displacement.
        let ratio = at(20.0) / at(40.0);
        assert!((ratio - 32.0).abs() < 1.0, "{ratio}");
        assert!(at(4.0) < 2e-3 * WAY.length());
    }

    #[test]
    fn nothing_is_compressed_anywhere() {
        const STEP: f64 = 1e-4;
        for offset in [[0.0, 0.0, 0.0], [0.1, 0.2, -0.3], [0.5, -0.1, 0.2], [1.5, 1.0, 0.0]] {
            let point = CENTRE + DVec3::from_array(offset);
            let slope =
                |axis: DVec3| (moved(point + axis * STEP) - moved(point - axis * STEP)).dot(axis) / (2.0 * STEP);
            let divergence: f64 = DVec3::AXES.into_iter().map(slope).sum();
            assert!(divergence.abs() < 1e-6, "{offset:?}: {divergence}");
        }
    }
}
