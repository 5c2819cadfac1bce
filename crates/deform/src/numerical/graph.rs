//! Graphs over a surface's vertices.

use pliant_mesh::{SurfaceVertex, Topology};

/// A graph over the surface's vertices.
pub(crate) trait Graph: Sync {
    /// The vertices that share an edge with this one, ascending.
    fn neighbours(&self, vertex: SurfaceVertex) -> &[SurfaceVertex];
}

impl Graph for Topology {
    fn neighbours(&self, vertex: SurfaceVertex) -> &[SurfaceVertex] {
        Topology::neighbours(self, vertex)
    }
}
