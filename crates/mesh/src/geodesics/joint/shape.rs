//! A surface in a given shape.

use glam::DVec3;

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
    pub(super) fn corners(&self, triangle: [SurfaceVertex; 3]) -> [DVec3; 3] {
        triangle.map(|v| self.positions[v.index()])
    }
}
