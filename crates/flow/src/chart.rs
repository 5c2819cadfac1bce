//! Triangles laid out in the plane.
//!
//! A flow needs no positions in space: each triangle has its own plane coordinates, in which its velocity and the ways
//! across it are given. The lengths are those from which the Laplacian has its weights ([`mollified_lengths`]), so that
//! gradients and the Laplacian fit together on any triangle, however thin.

use glam::{DVec2, DVec3};
use pliant_deform::mollified_lengths;
use pliant_mesh::{area_of_lengths, edge_lengths};

/// A triangle with corner 0 at the origin, corner 1 on the x axis and corner 2 above it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chart {
    /// The length from corner 0 to corner 1, above 0.
    base: f64,
    /// Corner 2; its y is above 0.
    apex: DVec2,
}

impl Chart {
    /// The layout of a triangle in space.
    pub fn of(corners: [DVec3; 3]) -> Self {
        let lengths = mollified_lengths(edge_lengths(corners));
        let [l0, l1, base] = lengths;
        let x = 0.5 * ((l1 - l0) * (l1 + l0) + base * base) / base;
        let y = 2.0 * area_of_lengths(lengths) / base;
        Self {
            base,
            apex: DVec2::new(x, y),
        }
    }

    /// The length from corner 0 to corner 1, and the coordinates of corner 2.
    #[inline(always)]
    pub fn layout(&self) -> [f64; 3] {
        [self.base, self.apex.x, self.apex.y]
    }

    /// The triangle with such a layout.
    #[inline(always)]
    pub fn with_layout([base, x, y]: [f64; 3]) -> Self {
        Self {
            base,
            apex: DVec2::new(x, y),
        }
    }

    /// The area.
    #[inline(always)]
    pub fn area(&self) -> f64 {
        0.5 * self.base * self.apex.y
    }

    /// The edge opposite a corner, counterclockwise.
    #[inline(always)]
    pub fn edge(&self, corner: usize) -> DVec2 {
        match corner {
            0 => DVec2::new(self.apex.x - self.base, self.apex.y),
            1 => -self.apex,
            _ => DVec2::new(self.base, 0.0),
        }
    }

    /// The gradients of the three barycentric coordinates; their sum is zero.
    #[inline(always)]
    pub fn gradients(&self) -> [DVec2; 3] {
        let across = self.apex.y.recip();
        let of_1 = DVec2::new(1.0, -self.apex.x * across) / self.base;
        let of_2 = DVec2::new(0.0, across);
        [-of_1 - of_2, of_1, of_2]
    }

    /// The vector along which the three barycentric coordinates change by `rates`.
    #[inline(always)]
    pub fn along(&self, rates: [f64; 3]) -> DVec2 {
        DVec2::new(self.base * rates[1] + self.apex.x * rates[2], self.apex.y * rates[2])
    }

    /// The gradient of the linear function with these values at the corners, times the area.
    #[inline(always)]
    pub fn gradient_area(&self, values: [f64; 3]) -> DVec2 {
        // A ∇φ is half the edge opposite, turned to the left.
        (self.edge(1) * (values[1] - values[0]) + self.edge(2) * (values[2] - values[0])).perp() * 0.5
    }

    /// The gradient of the linear function with these values at the corners.
    #[inline(always)]
    pub fn gradient(&self, values: [f64; 3]) -> DVec2 {
        let [_, of_1, of_2] = self.gradients();
        of_1 * (values[1] - values[0]) + of_2 * (values[2] - values[0])
    }

    /// The angle at a corner.
    pub fn angle(&self, corner: usize) -> f64 {
        let (to_next, to_last) = (self.edge((corner + 2) % 3), -self.edge((corner + 1) % 3));
        to_next.perp_dot(to_last).atan2(to_next.dot(to_last))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layout_has_the_triangle_s_lengths_angles_and_gradients() {
        let corners = [
            DVec3::new(1.0, 0.2, -0.5),
            DVec3::new(1.3, 0.1, -0.4),
            DVec3::new(0.9, 0.8, -0.1),
        ];
        let chart = Chart::of(corners);
        for k in 0..3 {
            let (a, b) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
            assert!((chart.edge(k).length() - a.distance(b)).abs() < 1e-14);
            let angle = (a - corners[k]).angle_between(b - corners[k]);
            assert!((chart.angle(k) - angle).abs() < 1e-7);
        }
        let slope = DVec2::new(0.3, -1.7);
        let corners = [DVec2::ZERO, chart.edge(2), -chart.edge(1)];
        let gradient = chart.gradient(corners.map(|corner| slope.dot(corner) + 5.0));
        assert!((gradient - slope).length() < 1e-12);
    }

    #[test]
    fn a_triangle_without_area_is_laid_out_with_a_little() {
        let corners = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
        let chart = Chart::of(corners);
        assert!(chart.area() > 0.0 && chart.gradients().iter().all(|gradient| gradient.is_finite()));
    }
}
