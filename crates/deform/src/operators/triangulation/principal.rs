//! Anisotropy: the surface is measured as if it were stretched along its principal axes to be about as wide as long
//! ([BK04]; [BS08, section 4]: "the model is anisotropically scaled along its principal axes to have
//! uniform variation").
//!
//! A bi-Laplacian's deformation fades over a length like its width, so that a long bar whose end is turned twists near
//! that end alone. The stretched bar is as wide as long, and its twist spreads evenly over all of it.

use glam::{DMat3, DVec3};
use pliant_mesh::{Surface, SurfaceVertex, Topology, face_area};

use crate::numerical::eigen::eigenvectors;

/// Axes along which the surface is thinner than this share of its longest are stretched as if it were that wide: so
/// that a flat sheet's bumps don't count as width.
const THINNEST: f64 = 0.1;

/// Stretches closer to 1 than this count as 1.
const NEGLIGIBLE: f64 = 1e-9;

/// The map of each component's edges for an anisotropy from 0, none, to 1, equal variation along all axes; empty if
/// none is stretched.
///
/// The axes are those of the part that may move: the triangles at free and softly held vertices, by area.
pub(crate) fn stretches(
    surface: &Surface,
    topology: &Topology,
    anisotropy: f64,
    may_move: &dyn Fn(SurfaceVertex) -> bool,
) -> Vec<DMat3> {
    if anisotropy == 0.0 {
        return Vec::new();
    }
    let mut moments = vec![Moments::NONE; topology.components().len()];
    for corners in &surface.triangles {
        if corners.iter().any(|&corner| may_move(corner)) {
            let component = topology.component(corners[0]) as usize;
            moments[component].add(corners.map(|corner| surface.positions[corner.index()]));
        }
    }
    let stretches: Vec<DMat3> = moments.iter().map(|moments| moments.stretch(anisotropy)).collect();
    if stretches.iter().all(|stretch| *stretch == DMat3::IDENTITY) {
        return Vec::new();
    }
    stretches
}

/// Area, first and second moments of triangles, about one of their points.
#[derive(Clone, Copy, Debug)]
struct Moments {
    origin: Option<DVec3>,
    area: f64,
    first: DVec3,
    second: DMat3,
}

impl Moments {
    /// The moments of nothing.
    const NONE: Self = Self {
        origin: None,
        area: 0.0,
        first: DVec3::ZERO,
        second: DMat3::ZERO,
    };

    fn add(&mut self, positions: [DVec3; 3]) {
        let origin = *self.origin.get_or_insert(positions[0]);
        let area = face_area(positions);
        let corners = positions.map(|position| position - origin);
        let sum = corners[0] + corners[1] + corners[2];
        self.area += area;
        self.first += sum * (area / 3.0);
        // ∫ x xᵀ over a triangle.
        for point in [corners[0], corners[1], corners[2], sum] {
            self.second += outer(point) * (area / 12.0);
        }
    }

    /// R diag(s) Rᵀ with the principal axes R and s = (σ_max / σ) to the power of the anisotropy.
    fn stretch(&self, anisotropy: f64) -> DMat3 {
        if self.area.is_nan() || self.area <= 0.0 {
            return DMat3::IDENTITY;
        }
        let covariance = self.second * self.area.recip() - outer(self.first / self.area);
        let (axes, variances) = eigenvectors(&covariance);
        let largest = variances.max_element();
        if largest.is_nan() || largest <= 0.0 {
            return DMat3::IDENTITY;
        }
        let factor = |variance: f64| {
            let width = (variance.max(0.0) / largest).sqrt().max(THINNEST);
            width.powf(-anisotropy)
        };
        let factors = DVec3::new(factor(variances.x), factor(variances.y), factor(variances.z));
        if (factors - 1.0).abs().max_element() < NEGLIGIBLE {
            return DMat3::IDENTITY;
        }
        axes * DMat3::from_diagonal(factors) * axes.transpose()
    }
}

fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

#[cfg(test)]
mod tests {
    use super::Moments;
    use glam::{DMat3, DQuat, DVec3};

    /// A box with these half sides, turned and far away.
    fn moments(half: DVec3, turn: DQuat) -> Moments {
        let mut moments = Moments::NONE;
        let corner = |k: usize| {
            let sign = |bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
            turn * (half * DVec3::new(sign(0), sign(1), sign(2))) + DVec3::new(1e5, -3e5, 2e5)
        };
        for [a, b, c, d] in [
            [0, 1, 3, 2],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 3, 7, 6],
            [0, 2, 6, 4],
            [1, 3, 7, 5],
        ] {
            moments.add([corner(a), corner(b), corner(c)]);
            moments.add([corner(a), corner(c), corner(d)]);
        }
        moments
    }

    #[test]
    fn a_box_is_stretched_along_its_thin_axes_and_a_cube_is_not() {
        let turn = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.9);
        assert_eq!(moments(DVec3::ONE, turn).stretch(1.0), DMat3::IDENTITY);
        let long = moments(DVec3::new(4.0, 1.0, 1.0), turn);
        let none = long.stretch(0.0);
        assert!((none - DMat3::IDENTITY).to_cols_array().iter().all(|x| x.abs() < 1e-12));
        let (half, whole) = (long.stretch(0.5), long.stretch(1.0));
        let along = |stretch: DMat3, axis: DVec3| (stretch * (turn * axis)).dot(turn * axis);
        for stretch in [half, whole] {
            assert!((along(stretch, DVec3::X) - 1.0).abs() < 1e-9);
            assert!((along(stretch, DVec3::Y) - along(stretch, DVec3::Z)).abs() < 1e-9);
        }
        assert!((along(half, DVec3::Y).powi(2) - along(whole, DVec3::Y)).abs() < 1e-9);
        assert!(along(whole, DVec3::Y) > 2.5, "{whole}");
    }

    #[test]
    fn a_flat_sheet_is_stretched_no_further_than_its_bound() {
        let flat = moments(DVec3::new(1.0, 1.0, 0.0), DQuat::IDENTITY).stretch(1.0);
        assert!(
            (flat - DMat3::from_diagonal(DVec3::new(1.0, 1.0, 10.0)))
                .to_cols_array()
                .iter()
                .all(|x| x.abs() < 1e-9)
        );
    }
}
