//! The sides of a cage or lattice: what is turned to the eye, and what is at its back.
//!
//! Front and back of a net are the same lines on the screen, so the back is drawn fainter, and its points are taken last.

use std::collections::BTreeSet;

use glam::DVec3;

use super::camera::Camera;

/// The points and edges of a net's triangles that are turned to the eye.
#[derive(Debug, Default)]
pub(crate) struct NetSides {
    points: BTreeSet<u32>,
    edges: BTreeSet<[u32; 2]>,
}

impl NetSides {
    /// The sides of a net at these positions; the triangles of its outside are all turned outwards, or all inwards.
    pub(crate) fn of(positions: &[DVec3], outside: &[[u32; 3]], camera: &Camera) -> Self {
        let corners = |triangle: &[u32; 3]| triangle.map(|point| positions[point as usize]);
        let first = positions.first().copied().unwrap_or_default();
        let volume = |triangle: &[u32; 3]| {
            let [a, b, c] = corners(triangle).map(|corner| corner - first);
            a.dot(b.cross(c))
        };
        let outwards = outside.iter().map(volume).sum::<f64>().signum();
        let is_front = |triangle: &&[u32; 3]| {
            let [a, b, c] = corners(triangle);
            (b - a).cross(c - a).dot(camera.towards_eye((a + b + c) / 3.0)) * outwards > 0.0
        };
        let mut own = Self::default();
        for &[a, b, c] in outside.iter().filter(is_front) {
            own.points.extend([a, b, c]);
            own.edges
                .extend([[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]));
        }
        own
    }

    /// Returns true if a point is at the back, or inside.
    pub(crate) fn is_back(&self, point: u32) -> bool {
        !self.points.contains(&point)
    }

    /// Returns true if an edge, with its lower point first, is at the back, or inside.
    pub(crate) fn is_back_edge(&self, edge: [u32; 2]) -> bool {
        !self.edges.contains(&edge)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::NetSides;
    use crate::view::{Camera, Projection};

    /// A cube of 3 × 3 × 3 points around the origin, and the triangles of its outside turned outwards.
    fn cube() -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let number = |x: u32, y: u32, z: u32| x + 3 * (y + 3 * z);
        let places = (0..27_u32).map(|n| DVec3::new(f64::from(n % 3), f64::from(n / 3 % 3), f64::from(n / 9)) - 1.0);
        let mut triangles = Vec::new();
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            for axis in 0..3 {
                let at = |level: u32, i: u32, j: u32| match axis {
                    0 => number(level, i, j),
                    1 => number(j, level, i),
                    _ => number(i, j, level),
                };
                let cell = |level| {
                    [
                        at(level, i, j),
                        at(level, i + 1, j),
                        at(level, i + 1, j + 1),
                        at(level, i, j + 1),
                    ]
                };
                let ([a, b, c, d], [e, f, g, h]) = (cell(2), cell(0));
                triangles.extend([[a, b, c], [a, c, d], [e, g, f], [e, h, g]]);
            }
        }
        (places.collect(), triangles)
    }

    #[test]
    fn the_points_of_sides_that_face_the_eye_are_in_front_whichever_way_the_net_is_turned() {
        let (positions, outwards) = cube();
        let inwards: Vec<[u32; 3]> = outwards.iter().map(|&[a, b, c]| [a, c, b]).collect();
        for projection in [Projection::Perspective, Projection::Orthographic] {
            for (yaw_rad, pitch_rad) in [(0.5, 0.4), (-0.7, 0.3), (2.5, -0.6), (4.0, 0.8)] {
                let camera = Camera {
                    yaw_rad,
                    pitch_rad,
                    projection,
                    distance: 12.0,
                    ..Camera::default()
                };
                let eye = camera.towards_eye(DVec3::ZERO);
                for outside in [&outwards, &inwards] {
                    let sides = NetSides::of(&positions, outside, &camera);
                    for (number, position) in (0..).zip(&positions) {
                        let is_front = (*position * eye.signum()).max_element() == 1.0;
                        assert_eq!(sides.is_back(number), !is_front, "{position} seen from {eye}");
                    }
                    // Along the silhouette both sides share an edge, which is in front; across the cube none is.
                    assert!(sides.is_back_edge([4, 13]) && sides.is_back_edge([10, 13]), "{eye}");
                    let corner = |signs: DVec3| positions.iter().position(|p| *p == signs).unwrap_or_default() as u32;
                    let near = corner(eye.signum());
                    let beside = corner(eye.signum() * DVec3::new(0.0, 1.0, 1.0));
                    assert!(!sides.is_back_edge([near.min(beside), near.max(beside)]), "{eye}");
                    let far = corner(-eye.signum());
                    let beside = corner(-eye.signum() * DVec3::new(0.0, 1.0, 1.0));
                    assert!(sides.is_back_edge([far.min(beside), far.max(beside)]), "{eye}");
                }
            }
        }
    }
}
