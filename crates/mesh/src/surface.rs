//! The welded triangle surface that the solver works on, and the bare points beside it.

use glam::DVec3;

use crate::SurfaceVertex;

/// Welded vertices and the triangles over them, in world space, f64.
///
/// Vertices are in Morton order of their rest positions and triangles in order of their lowest, then their middle, then
/// their highest vertex, so that neighbours on the surface are neighbours in memory. Bare points, which no triangle
/// uses, come last, in Morton order among themselves. Every triangle has three different vertices; no two triangles
/// have the same three vertices. Zero-area triangles, non-manifold edges, holes and several components may occur.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// World positions, all finite.
    pub positions: Vec<DVec3>,
    /// Counterclockwise seen from outside.
    pub triangles: Vec<[SurfaceVertex; 3]>,
}

impl Surface {
    /// The three positions of triangle `t`.
    #[inline]
    pub fn corners(&self, t: usize) -> [DVec3; 3] {
        corners(self.triangles[t], &self.positions)
    }
}

/// The positions of a triangle's corners.
#[inline]
pub(crate) fn corners<V: Copy>(triangle: [SurfaceVertex; 3], positions: &[V]) -> [V; 3] {
    triangle.map(|v| positions[v.index()])
}
