//! An OBJ file as stored.

use std::ops::Range;
use std::sync::Arc;

use super::materials::Materials;
use super::statements::Statements;
use crate::appearance::Group;
use crate::convert::Polygons;

/// An OBJ file as stored.
#[derive(Debug)]
pub(crate) struct Stored {
    pub(super) bytes: Arc<Vec<u8>>,
    /// Without its positions, corners and faces, which the drawn set and `polygons` replace.
    pub(super) statements: Statements,
    /// The `vt` of each drawn vertex; empty if none has one.
    pub(super) uv: Vec<u32>,
    /// The `vn` of each drawn vertex; empty if none has one.
    pub(super) normal: Vec<u32>,
    /// The faces, if one has more than three corners.
    pub(super) polygons: Option<Polygons>,
    /// The `v` line of each drawn vertex.
    pub(super) position: Vec<u32>,
    pub(super) groups: Vec<Group>,
    /// The drawn vertices that belong only to flat faces.
    pub(super) flat: Vec<Range<u32>>,
    pub(super) materials: Materials,
    pub(super) notes: Vec<String>,
}
