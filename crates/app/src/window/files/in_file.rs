//! What a shape's own file on the disk holds of it.

use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{Dye, Former};

/// The relation of the open file's present triangles to the file at its path.
#[derive(Clone, Debug)]
pub enum InFile {
    /// They were read from it.
    AsRead,
    /// They were saved there.
    Saved(SavedShape),
    /// No file has them: this step, by its name, has made them from a former mesh.
    Made(&'static str, Former),
    /// There is no such file, or it has other triangles, or what it has is unknown.
    Unknown,
}

/// A shape in a file.
#[derive(Clone, Debug)]
pub struct SavedShape {
    /// The displacements, per surface vertex.
    pub displacements: Arc<Vec<DVec3>>,
    /// The kept dye in the file's colours, per surface vertex.
    pub dye: Option<Arc<Vec<Dye>>>,
}

impl InFile {
    /// The saved shape.
    pub fn saved(&self) -> Option<&SavedShape> {
        match self {
            Self::Saved(saved) => Some(saved),
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
