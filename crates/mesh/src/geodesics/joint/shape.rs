//! A surface in a given shape.

use glam::DVec3;

use crate::geometry::nearest_on_triangle;
use crate::{SurfaceVertex, Topology};

/// A surface in a given shape.
#[derive(Clone, Copy, Debug)]
pub struct Shape<'a> {
    /// Its triangles.
    pub triangles: &'a [[SurfaceVertex; 3]],
    /// Their connectivity.
    pub topology: &'a Topology,
    /// The positions of the vertices, in world units.
    pub positions: &'a [DVec3],
}

impl Shape<'_> {
    /// The triangle nearest to `point` (the lowest if there are several), and its nearest point; `None` without
    /// triangles.
    pub fn nearest(&self, point: DVec3) -> Option<(u32, DVec3)> {
        let mut best: Option<(f64, u32, DVec3)> = None;
        for (number, &triangle) in (0..).zip(self.triangles) {
            let near = nearest_on_triangle(point, self.corners(triangle));
            let distance = near.distance_squared(point);
            if best.is_none_or(|(least, ..)| distance < least) {
                best = Some((distance, number, near));
            }
        }
        best.map(|(_, number, near)| (number, near))
    }

    pub(super) fn corners(&self, triangle: [SurfaceVertex; 3]) -> [DVec3; 3] {
        triangle.map(|v| self.positions[v.index()])
    }
}
