//! The surface's own triangles as a triangulation, measured in space or along stretched axes.

use glam::{DMat3, DVec3};
use pliant_mesh::{Surface, Topology, edge_lengths};

/// The surface's own triangles.
#[derive(Clone, Debug)]
pub(crate) struct SurfaceTriangulation<'a> {
    pub surface: &'a Surface,
    pub topology: &'a Topology,
    /// The map applied to each component's edges before they are measured; empty if there is none.
    pub stretches: Vec<DMat3>,
}

impl SurfaceTriangulation<'_> {
    /// A triangle's edge lengths, entry `i` opposite corner `i`.
    pub fn lengths(&self, face: u32) -> [f64; 3] {
        let corners = self.surface.triangles[face as usize];
        let [a, b, c] = corners.map(|corner| self.surface.positions[corner.index()]);
        match self.stretches.get(self.topology.component(corners[0]) as usize) {
            None => edge_lengths([a, b, c]),
            // Differences are taken first: a map of positions far from the origin would cost digits.
            Some(stretch) => edge_lengths([DVec3::ZERO, *stretch * (b - a), *stretch * (c - a)]),
        }
    }
}
