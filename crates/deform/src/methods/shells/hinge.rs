//! The angle at an edge between its two triangles.
//!
//! A hinge has the corners a, b, c, d: the edge from a to b and the two vertices across it. With e = b − a, n₁ = e ×
//! (c − a) and n₂ = (d − a) × e the angle from n₁ to n₂ about e is 0 where the triangles are coplanar, and does not
//! depend on their orientation in the file. Its gradient is −u₁ at c and −u₂ at d with u = |e| n / |n|², and the shares
//! of u₁ + u₂ that keep moments at a and b.

use std::f64::consts::TAU;

use glam::DVec3;

/// A triangle has no direction if its normal is shorter than this share of the edge's square.
const NO_AREA: f64 = 1e-12;

/// The angle in radians, from −π to π.
pub(super) fn angle_rad([a, b, c, d]: [DVec3; 4]) -> f64 {
    let edge = b - a;
    let (one, other) = (edge.cross(c - a), (d - a).cross(edge));
    let sine = one.cross(other).dot(edge);
    sine.atan2(one.dot(other) * edge.length())
}

/// Adds whole turns to the angle so that it is nearest to `near`.
pub(super) fn unwrapped(angle_rad: f64, near_rad: f64) -> f64 {
    angle_rad + TAU * ((near_rad - angle_rad) / TAU).round()
}

/// The angle's gradient at the four corners, in radians per unit of length. A triangle without an area has a zero
/// gradient.
pub(super) fn gradient([a, b, c, d]: [DVec3; 4]) -> [DVec3; 4] {
    let edge = b - a;
    let square = edge.length_squared();
    if square == 0.0 {
        return [DVec3::ZERO; 4];
    }
    let (one, other) = (edge.cross(c - a), (d - a).cross(edge));
    let pull = |normal: DVec3| {
        let size = normal.length_squared();
        if size > (NO_AREA * square).powi(2) {
            normal * (square.sqrt() / size)
        } else {
            DVec3::ZERO
        }
    };
    let (u, v) = (pull(one), pull(other));
    let (s, t) = ((c - a).dot(edge) / square, (d - a).dot(edge) / square);
    [u * (1.0 - s) + v * (1.0 - t), u * s + v * t, -u, -v]
}

/// The angle as a linear function of heights above the plane into which the hinge is unfolded [WBHZG07]: the factors at
/// the four corners. They give zero for constants and for slopes.
pub(super) fn flat([a, b, c, d]: [DVec3; 4]) -> [f64; 4] {
    let edge = b - a;
    let square = edge.length_squared();
    let steep = |corner: DVec3| {
        let height = edge.cross(corner - a).length() / square.sqrt();
        (height.recip(), (corner - a).dot(edge) / square)
    };
    let ((u, s), (v, t)) = (steep(c), steep(d));
    [u * (1.0 - s) + v * (1.0 - t), u * s + v * t, -u, -v]
}

#[cfg(test)]
mod tests {
    use super::{angle_rad, flat, gradient, unwrapped};
    use glam::DVec3;

    fn folded(angle: f64) -> [DVec3; 4] {
        let wing = DVec3::new(0.7, 1.3 * angle.cos(), -1.3 * angle.sin());
        [DVec3::ZERO, DVec3::X * 2.0, DVec3::new(0.4, -0.9, 0.0), wing]
    }

    #[test]
    fn a_fold_has_its_angle_and_goes_on_beyond_half_a_turn() {
        let mut last = 0.0;
        for step in 0..80 {
            let expected = 0.1 * f64::from(step);
            let angle = angle_rad(folded(expected));
            last = unwrapped(angle, last);
            assert!((last.abs() - expected).abs() < 1e-9, "{expected}: {last}");
        }
        assert_eq!(unwrapped(3.0, 3.0), 3.0);
    }

    #[test]
    fn the_gradient_is_the_slope_of_the_angle() {
        for angle in [-2.9, -1.0, 0.0, 0.3, 2.0, 3.1] {
            let corners = folded(angle);
            let slopes = gradient(corners);
            for corner in 0..4 {
                for axis in DVec3::AXES {
                    let at = |step: f64| {
                        let mut moved = corners;
                        moved[corner] += axis * step;
                        unwrapped(angle_rad(moved), angle_rad(corners))
                    };
                    let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
                    assert!((slope - slopes[corner].dot(axis)).abs() < 1e-8, "{angle} {corner}");
                }
            }
        }
    }

    #[test]
    fn in_the_plane_the_gradient_is_the_linear_angle() {
        let corners = folded(0.0);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
        for (slope, factor) in gradient(corners).into_iter().zip(flat(corners)) {
            assert!((slope - normal * factor).length() < 1e-12);
        }
        for angle in [0.5, 2.0] {
            let factors = flat(folded(angle));
            assert!(factors.iter().zip(flat(corners)).all(|(a, b)| (a - b).abs() < 1e-9));
            assert!(factors.iter().sum::<f64>().abs() < 1e-12);
        }
    }
}
