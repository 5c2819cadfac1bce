//! The nearest of some points.

use glam::DVec3;
use pliant_mesh::{Bvh, SurfaceVertex};

/// Some of a surface's points, ordered for queries.
pub(crate) struct NearestPoints(Bvh);

impl NearestPoints {
    /// The points of these vertices, by the surface's positions.
    pub fn of(positions: &[DVec3], vertices: impl Iterator<Item = u32>) -> Self {
        // The hierarchy is one of triangles; a point is a triangle without extent.
        let points: Vec<_> = vertices.map(|vertex| [SurfaceVertex(vertex); 3]).collect();
        Self(Bvh::build(positions, &points))
    }

    /// The nearest one (the lowest if there are several), and its distance; `None` if there are no points.
    pub fn nearest(&self, point: DVec3) -> Option<(u32, f64)> {
        let (vertex, distance) = self.0.nearest_vertex(point)?;
        Some((vertex.0, distance))
    }
}
