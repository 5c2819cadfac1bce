//! The contents of a file, in counts.

use serde::Serialize;

/// The contents of a file, counted.
#[derive(Clone, PartialEq, Eq, Debug, Default, Serialize)]
#[expect(missing_docs, reason = "each count is of what its name says")]
pub struct Summary {
    pub meshes: usize,
    pub primitives: usize,
    pub nodes: usize,
    pub materials: usize,
    pub images: usize,
    pub skins: usize,
    pub animations: usize,
    pub morph_targets: usize,
}

impl Summary {
    /// The summary of a file whose triangles are one mesh.
    pub(crate) fn of_one_mesh(triangle_count: usize) -> Self {
        let meshes = usize::from(triangle_count > 0);
        Self {
            meshes,
            primitives: meshes,
            nodes: meshes,
            ..Self::default()
        }
    }
}
