//! The result of a search for a stroke's vertices.

use pliant_mesh::SurfaceVertex;

/// The vertices that a stroke encloses or follows, and their reach if it was searched for, too.
#[derive(Debug, Default)]
pub struct Enclosed {
    /// The vertices.
    pub(crate) vertices: Vec<SurfaceVertex>,
    /// The length along the surface, in world units, within which the surface beside them follows them.
    pub(crate) reach: Option<f64>,
}

impl From<Vec<SurfaceVertex>> for Enclosed {
    fn from(vertices: Vec<SurfaceVertex>) -> Self {
        Self { vertices, reach: None }
    }
}
