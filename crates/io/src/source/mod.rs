//! What a format's reader gets: a file's bytes, and the way to its neighbours.

pub(crate) mod notes;

use std::sync::Arc;

use pliant_mesh::{Cancel, Cancelled, Progress};

use crate::{Bytes, Format, ReadError};

/// Gives the bytes of a file's neighbours.
pub trait Resolver {
    /// The bytes of the neighbour at `uri`, a percent-decoded path with `/` between folders, relative to the file's
    /// own folder. A file may name the same neighbour many times and in several spellings, and keeps what it is given
    /// each time: share them. On failure: why, in words.
    fn read(&self, uri: &str) -> Result<Bytes, String>;
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

/// Bytes of a text between two looks at whether it is still wanted: some thousand numbers.
const BYTES_BETWEEN_LOOKS: usize = 1 << 15;

/// Where in the bytes a reader looked last whether its result is still wanted.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Looks {
    next: usize,
}

impl Source<'_> {
    /// Tells how far a reader is that has come to byte `at`, and looks whether its result is still wanted, now and
    /// then. Bytes are what counts, since a line, a face or a record may be as long as the file.
    #[inline]
    pub fn pass(&self, looks: &mut Looks, at: usize) -> Result<(), Cancelled> {
        if at >= looks.next {
            looks.next = at + BYTES_BETWEEN_LOOKS;
            self.progress.set(0.8 * at as f32 / self.bytes.len() as f32);
            self.cancel.check()?;
        }
        Ok(())
    }

    /// A [`ReadError::Malformed`] of this file.
    pub fn malformed(&self, format: Format, reason: impl Into<String>) -> ReadError {
        ReadError::Malformed {
            name: self.name.to_owned(),
            format,
            reason: reason.into(),
        }
    }
}
