//! The mesh of a project: its path, and its geometry's hash.

use pliant_mesh::Model;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::format::digest::hexadecimal;

/// The mesh of a project.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshReference {
    /// Its path, relative to the project's folder if it is below that; `None` is the built-in sample.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
    /// Its name, if its path doesn't give it: for a copy that was kept because the file was saved over.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Its [`geometry_hash`].
    pub geometry: String,
}

/// `sha256:` and the digest of the meaning of vertex numbers: the drawn positions' bits, the triangles and the file's
/// vertices behind the drawn ones.
pub fn geometry_hash(model: &Model) -> String {
    let mut hash = Sha256::new();
    let drawn = model.rest();
    for count in [drawn.positions.len(), drawn.triangles.len(), drawn.file_vertex_count] {
        hash.update((count as u64).to_le_bytes());
    }
    for position in &drawn.positions {
        hash.update(position.to_array().map(f64::to_le_bytes).as_flattened());
    }
    for triangle in &drawn.triangles {
        hash.update(triangle.map(|vertex| vertex.0.to_le_bytes()).as_flattened());
    }
    for vertex in &drawn.file_vertex {
        hash.update(vertex.0.to_le_bytes());
    }
    hexadecimal(hash)
}
