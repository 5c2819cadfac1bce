//! What a shape's own file on the disk holds of it.

use std::sync::Arc;

use glam::DVec3;
use pliant_editor::Former;

/// The relation of the open file's present triangles to the file at its path.
#[derive(Clone, Debug)]
pub enum InFile {
    /// They were read from it.
    AsRead,
    /// They were saved there with these displacements, per surface vertex.
    Saved(Arc<Vec<DVec3>>),
    /// No file has them: this step, by its name, has made them from a former mesh.
    Made(&'static str, Former),
    /// There is no such file, or it has other triangles, or what it has is unknown.
    Unknown,
}

impl InFile {
    /// The displacements with which they were saved.
    pub fn saved(&self) -> Option<&Arc<Vec<DVec3>>> {
        match self {
            Self::Saved(displacements) => Some(displacements),
            Self::AsRead | Self::Made(..) | Self::Unknown => None,
        }
    }

    /// Notes that a save of another shape has replaced the file.
    pub fn was_replaced(&mut self) {
        if !matches!(self, Self::Made(..)) {
            *self = Self::Unknown;
        }
    }
}
