//! A USDZ file as stored.

use std::ops::Range;
use std::sync::Arc;

use glam::DAffine3;

use super::mesh::Mesh;
use crate::Appearance;
use crate::convert::Polygons;

/// A mesh of the layer, as it is shown.
#[derive(Debug)]
pub(super) struct Instance {
    pub name: String,
    pub mesh: Mesh,
    /// To world space.
    pub transform: DAffine3,
    /// The number of the mesh's first point among the file's vertices.
    pub first_file_vertex: u32,
    /// Its drawn vertices: its points in order, and then those that have several looks.
    pub vertices: Range<u32>,
    /// The drawn vertex at each corner.
    pub corners: Vec<u32>,
}

/// A USDZ file as stored.
#[derive(Debug)]
pub(crate) struct Stored {
    pub(super) bytes: Arc<Vec<u8>>,
    /// The layer's place in the archive.
    pub(super) place: usize,
    /// The layer.
    pub(super) text: Vec<u8>,
    pub(super) instances: Vec<Instance>,
    /// The faces, if some are no triangles.
    pub(super) polygons: Option<Polygons>,
    pub(super) look: Appearance,
    pub(super) notes: Vec<String>,
}
