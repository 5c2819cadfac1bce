//! The input of a format's reader: a file's bytes and access to its neighbours.

pub(crate) mod notes;

use std::sync::Arc;

use pliant_mesh::{Cancel, Cancelled, Progress};

use crate::{Bytes, Format, ReadError};

/// Reads the bytes of a file's neighbours.
pub trait Resolver {
    /// Returns the bytes of the neighbour at `uri`, a percent-decoded path with `/` between folders, relative to the
    /// file's own folder. A file may refer to the same neighbour many times and in several spellings, and keeps every
    /// result, so share them. The error gives the reason, in words.
    fn read(&self, uri: &str) -> Result<Bytes, String>;

    /// Learns that the file names a neighbour at `uri` (as for [`read`](Self::read)) whose bytes are not needed, so
    /// that no output replaces it. Returns true if there is such a file.
    fn note_unread(&self, uri: &str) -> bool {
        let _ = uri;
        false
    }
}

/// The input of a format's reader.
pub(crate) struct Source<'a> {
    /// The file. A reader may keep a clone and refer to ranges of it.
    pub bytes: &'a Arc<Vec<u8>>,
    /// The file's name, for messages.
    pub name: &'a str,
    /// Its neighbours.
    pub resolver: &'a dyn Resolver,
    pub progress: &'a Progress,
    pub cancel: &'a Cancel,
}

/// Bytes of a text between two checks for cancelling: a few thousand numbers.
const BYTES_BETWEEN_LOOKS: usize = 1 << 15;

/// The place in the bytes where a reader last checked for cancelling.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Looks {
    next: usize,
}

impl Source<'_> {
    /// Reports now and then the progress of a reader that has reached byte `at`, and checks for cancelling. It counts
    /// bytes, because a line, a face or a record may be as long as the file.
    #[inline]
    pub fn pass(&self, looks: &mut Looks, at: usize) -> Result<(), Cancelled> {
        if at >= looks.next {
            looks.next = at + BYTES_BETWEEN_LOOKS;
            self.progress.set(0.8 * at as f32 / self.bytes.len() as f32);
            self.cancel.check()?;
        }
        Ok(())
    }

    /// A [`ReadError::Malformed`] for this file.
    pub fn malformed(&self, format: Format, reason: impl Into<String>) -> ReadError {
        ReadError::Malformed {
            name: self.name.to_owned(),
            format,
            reason: reason.into(),
        }
    }
}
