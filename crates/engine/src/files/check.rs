//! Reads a written file back, before it replaces anything.

use std::path::{Path, PathBuf};

use pliant_io::{Bytes, Format, ReadError, Resolver, SceneAndDrawn};
use pliant_mesh::{Cancel, Progress};

use super::{Destination, Neighbours};
use crate::EngineError;

/// A written file that is not in its place yet.
pub struct Written<'a> {
    /// The place of OUT.
    pub output: &'a Destination,
    /// Its bytes on the disk.
    pub file: &'a Path,
    /// The neighbours that were written with it, by name, and their bytes on the disk.
    pub neighbours: Vec<(String, &'a Path)>,
}

/// Reads a save back from the disk, like the next reader, and compares its shape with the one to save, by `compare`. It
/// is the last check before the old file is replaced.
///
/// # Errors
/// [`EngineError::ReadBack`] if it can't be read or shows another shape; [`EngineError::Interrupted`] soon after
/// `cancel` is raised.
pub fn read_back(
    written: &Written<'_>,
    format: Format,
    compare: impl FnOnce(&SceneAndDrawn) -> Result<(), String>,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<(), EngineError> {
    let refuse = |what: String| EngineError::ReadBack {
        file: written.output.given.clone(),
        what,
    };
    let resolver = AmongWritten {
        written: written
            .neighbours
            .iter()
            .map(|(name, path)| (name.clone(), path.to_path_buf()))
            .collect(),
        beside: Neighbours::of(&written.output.target),
    };
    let name = written.output.given.to_string_lossy();
    let bytes = super::read(written.file)?;
    let back = pliant_io::read(bytes, format, &name, &resolver, progress, cancel).map_err(|error| match error {
        ReadError::Cancelled(_) => EngineError::Interrupted,
        error => refuse(error.to_string()),
    })?;
    cancel.check().map_err(|_| EngineError::Interrupted)?;
    compare(&back).map_err(refuse)
}

/// Neighbours in their future state: new ones from their temporary files, the others from beside OUT.
struct AmongWritten {
    written: Vec<(String, PathBuf)>,
    beside: Neighbours,
}

impl Resolver for AmongWritten {
    fn read(&self, uri: &str) -> Result<Bytes, String> {
        let steps = uri.split('/').filter(|step| !matches!(*step, "" | "."));
        let plain = steps.collect::<Vec<_>>().join("/");
        match self.written.iter().find(|(name, _)| *name == plain) {
            Some((_, path)) => super::read(path).map(Bytes::from).map_err(|error| error.reason()),
            None => self.beside.read(uri),
        }
    }
}
