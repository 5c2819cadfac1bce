//! The differences of two files.

use std::path::Path;

use pliant_io::{Difference, Scene};
use pliant_mesh::Drawn;

use crate::watch::Watch;
use crate::{EngineError, Loaded, open};

/// A file to compare.
#[derive(Clone, Copy, Debug)]
pub enum Compared<'a> {
    /// A file to read.
    File(&'a Path),
    /// A file that was read.
    Loaded(&'a Loaded),
}

/// The differences of two files; empty if they hold the same.
///
/// # Errors
/// A file that can't be read.
pub fn differences(first: Compared, second: Compared, watch: &Watch) -> Result<Vec<Difference>, EngineError> {
    first.with(watch, |scene, drawn| {
        second.with(watch, |other, other_drawn| scene.differences(drawn, other, other_drawn))
    })?
}

impl Compared<'_> {
    fn with<T>(&self, watch: &Watch, read: impl FnOnce(&Scene, &Drawn) -> T) -> Result<T, EngineError> {
        Ok(match self {
            Self::File(path) => {
                let opened = open(path, watch)?;
                read(&opened.scene, &opened.drawn)
            }
            Self::Loaded(loaded) => read(&loaded.scene, &loaded.model.rest()),
        })
    }
}
