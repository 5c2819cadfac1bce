//! A triangle's area: its gradient, and a barrier that keeps compressed triangles from losing it.
//!
//! ½ w (A − Ā)² is finite at A = 0, while the gradient of the angles at a triangle grows without bound as it loses its
//! height: a triangle that has come so far does not recover. So below the least area Â that rest and examples give it,
//! a triangle has an additional energy. With x = A / Â the sum is w Â² / 4 (x² − 1 − 2 log x) where Â is Ā: as stiff
//! for small changes, and without bound at 0. On the arm of a scan that is bent by 90° the smallest area was a quarter
//! of a percent without it. It is zero above Â, so that stretching costs as before and examples are met.

use glam::DVec3;
use pliant_mesh::face_normal;

use super::elements::Face;

/// A smaller share of a triangle's area counts as this one.
const SMALLEST: f64 = 1e-12;

/// The area's gradient at the three corners. A triangle without an area gives none.
pub(super) fn gradient([a, b, c]: [DVec3; 3]) -> [DVec3; 3] {
    let normal = face_normal([a, b, c]);
    [c - b, a - c, b - a].map(|opposite| 0.5 * normal.cross(opposite))
}

/// The barrier's addition to a triangle's energy, and its first and second derivative by the area.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) struct Barrier {
    pub energy: f64,
    pub slope: f64,
    pub curvature: f64,
}

impl Barrier {
    /// The barrier of a triangle that has this area.
    pub fn of(face: &Face, area: f64) -> Self {
        let Face { weight, least, .. } = *face;
        if least <= 0.0 || area >= least {
            return Self::default();
        }
        let x = (area / least).max(SMALLEST);
        let missing = 1.0 - x;
        Self {
            energy: 0.25 * weight * least * least * (x * x - 1.0 - 2.0 * x.ln() - 2.0 * missing * missing),
            slope: -0.5 * weight * least * missing * missing / x,
            curvature: 0.5 * weight * (1.0 / (x * x) - 1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Barrier, Face};

    #[test]
    fn the_barrier_has_its_derivatives_and_no_corner_and_grows_without_bound() {
        let face = Face {
            corners: [0, 1, 2],
            area: 3.0,
            weight: 0.7,
            least: 2.0,
        };
        for area in [0.01, 0.3, 1.1, 1.9] {
            let step = 1e-6 * area;
            let [below, here, above] = [-step, 0.0, step].map(|more| Barrier::of(&face, area + more));
            assert!(((above.energy - below.energy) / (2.0 * step) / here.slope - 1.0).abs() < 1e-5);
            assert!(((above.slope - below.slope) / (2.0 * step) / here.curvature - 1.0).abs() < 1e-5);
        }
        assert_eq!(Barrier::of(&face, 2.0), Barrier::default());
        assert!(Barrier::of(&face, 1.999).curvature < 1e-3);
        let ways = [1e-2, 1e-4, 1e-8].map(|area| Barrier::of(&face, area).energy);
        assert!(
            ways.windows(2)
                .all(|pair| pair[1] > pair[0] + 0.25 * 0.7 * 4.0 * 2.0 * 4.0)
        );
    }
}
