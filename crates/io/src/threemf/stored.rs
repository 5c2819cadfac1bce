//! A 3MF file as stored.

use std::ops::Range;
use std::sync::Arc;

use glam::DAffine3;

use super::model::Object;
use crate::Appearance;

/// A model part of the archive.
#[derive(Debug)]
pub(super) struct Part {
    /// The place in the archive.
    pub place: usize,
    pub bytes: Vec<u8>,
    pub objects: Vec<Object>,
}

/// An object with a mesh, as the build list shows it.
#[derive(Clone, Debug)]
pub(super) struct Instance {
    pub part: usize,
    pub object: usize,
    /// The number of the object's first vertex among the file's vertices.
    pub first_file_vertex: u32,
    /// To world space.
    pub transform: DAffine3,
    /// Its drawn vertices.
    pub vertices: Range<u32>,
    /// Its drawn triangles, in the object's order.
    pub triangles: Range<u32>,
}

/// A 3MF file as stored.
#[derive(Debug)]
pub(crate) struct Stored {
    pub(super) bytes: Arc<Vec<u8>>,
    pub(super) parts: Vec<Part>,
    pub(super) instances: Vec<Instance>,
    pub(super) look: Appearance,
    pub(super) notes: Vec<String>,
}
