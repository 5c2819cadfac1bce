//! A file as stored, in any format, and the only place that distinguishes formats.
//!
//! Each format is one module with the same interface: `read(&Source) -> Result<(Stored, Drawn), ReadError>`;
//! `Stored::{notes, summary, appearance, write}`, where `write(&Moved, &Course)` returns the file with only the moved
//! vertices' numbers changed, and warnings (it is called only if something moved); and `write_new(&NewMesh, &Course)`,
//! which converts a mesh of any other format.

mod check;
mod colours;
mod differences;
mod losses;
pub(crate) mod pose;
mod reading;
mod rename;
mod saving;
mod stored;
mod targets;
pub(crate) mod unsaved;
mod writing;

pub use reading::{SceneAndDrawn, read};
pub use stored::Scene;
