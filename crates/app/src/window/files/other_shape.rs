//! The open file with other triangles than the present ones.

use std::sync::Arc;

use pliant_engine::Loaded;
use pliant_picture::drawing::Drawing;
use pliant_render::Surface;

use super::in_file::InFile;
use super::rest_mesh::RestMesh;

/// The open file with other triangles than the present ones.
pub struct OtherShape {
    /// The file as stored, in memory or on the disk.
    pub loaded: Arc<Loaded>,
    /// The names of its morph targets.
    pub morph_targets: Vec<String>,
    /// Its data for the renderer.
    pub drawing: Arc<Drawing>,
    /// Its own surface in GPU buffers, until it is shown.
    pub surface: Option<Surface>,
    /// It without displacements, and its present place.
    pub mesh: RestMesh,
    /// What the file at the open file's path holds of it.
    pub in_file: InFile,
    /// True if a person agreed that it replaces the file at that path.
    pub may_write_over: bool,
}
