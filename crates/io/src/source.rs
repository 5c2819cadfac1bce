//! What a format's reader gets: a file's bytes, and the way to its neighbours.

use std::sync::Arc;

use pliant_mesh::{Cancel, Progress};

use crate::{Format, ReadError};

/// Gives the bytes of a file's neighbours.
pub trait Resolver {
    /// The bytes of the neighbour at `uri`, a percent-decoded path with `/` between folders, relative to the file's
    /// own folder unless it is absolute. On failure: why, in words.
    fn read(&self, uri: &str) -> Result<Vec<u8>, String>;
}

/// What a format's reader gets.
pub(crate) struct Source<'a> {
    /// The file. A reader may keep a clone and point into it.
    pub bytes: &'a Arc<Vec<u8>>,
    /// The file's name, for messages.
    pub name: &'a str,
    /// Its neighbours.
    pub resolver: &'a dyn Resolver,
    pub progress: &'a Progress,
    pub cancel: &'a Cancel,
}

impl Source<'_> {
    /// A [`ReadError::Malformed`] of this file.
    pub fn malformed(&self, format: Format, reason: impl Into<String>) -> ReadError {
        ReadError::Malformed {
            name: self.name.to_owned(),
            format,
            reason: reason.into(),
        }
    }
}
