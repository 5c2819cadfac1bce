//! An OFF file as stored.

use std::sync::Arc;

use super::records::Records;
use crate::convert::Polygons;

/// An OFF file as stored.
#[derive(Debug)]
pub(crate) struct Stored {
    pub(super) bytes: Arc<Vec<u8>>,
    /// Without its positions and faces, which the drawn set and `polygons` replace.
    pub(super) records: Records,
    /// The faces, if one has more than three corners.
    pub(super) polygons: Option<Polygons>,
    pub(super) triangle_count: u32,
    /// The number of the file's faces, including those that aren't drawn.
    pub(super) face_count: usize,
    pub(super) notes: Vec<String>,
}
