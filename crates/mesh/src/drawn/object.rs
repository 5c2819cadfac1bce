//! An object of a file: the triangles that one node shows in one material.

use std::ops::Range;

/// Triangles that share node and material.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Object {
    /// The node's, object's or group's name; empty if the file gives none.
    pub name: String,
    /// The material's name; empty if the file gives none.
    pub material: String,
    /// Runs of [`crate::Drawn::triangles`], ascending.
    pub triangles: Vec<Range<u32>>,
}
