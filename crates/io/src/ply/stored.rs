//! A PLY file as stored.

use std::sync::Arc;

use super::header::Header;
use super::records::{Columns, Places};
use super::textures::Textures;
use crate::appearance::{Group, Material};
use crate::convert::Polygons;
use crate::{Format, SaveError};

/// A PLY file as stored.
#[derive(Debug)]
pub(crate) struct Stored {
    pub(super) bytes: Arc<Vec<u8>>,
    pub(super) header: Header,
    pub(super) vertex_element: Option<usize>,
    pub(super) columns: Columns,
    pub(super) places: Places,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) colours: Vec<[f32; 4]>,
    pub(super) uvs: Vec<[f32; 2]>,
    /// The file vertex behind each drawn vertex that comes after all of the file's.
    pub(super) further: Vec<u32>,
    pub(super) textures: Textures,
    pub(super) materials: Vec<Material>,
    pub(super) groups: Vec<Group>,
    /// The faces, if one has more than three corners.
    pub(super) polygons: Option<Polygons>,
    pub(super) triangle_count: u32,
    pub(super) notes: Vec<String>,
}

/// The refusal of a change that the file can't hold.
pub(super) fn cannot_hold(what: String, remedy: &str) -> SaveError {
    SaveError::CannotHold {
        what,
        format: Format::Ply,
        remedy: remedy.to_owned(),
    }
}
