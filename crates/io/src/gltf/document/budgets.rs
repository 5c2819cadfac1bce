//! The memory that a glTF may take: a multiple of the bytes that were read.

use std::collections::HashSet;

use super::Document;
use super::origin::{Buffer, ImageFile};

/// The bytes of geometry allowed for each byte of the file.
const MOST_GROWTH: usize = 64;

/// The bytes of the drawn set allowed for each byte of geometry.
const MOST_DRAWN: usize = 16;

/// The allowance for the drawn set of the smallest files: five million triangles.
const DRAWN_ANYWAY: usize = 64 << 20;

/// The allowance for compressed geometry in the smallest files.
const DECODED_ANYWAY: usize = 1 << 20;

impl Document {
    /// The bytes that compressed geometry may take in all.
    pub fn decoding_budget(&self) -> usize {
        self.loaded_bytes.saturating_mul(MOST_GROWTH).max(DECODED_ANYWAY)
    }

    /// The bytes of memory that the drawn set may take: enough for the file's bytes, and for small files with many
    /// instances.
    ///
    /// No accessor seen through one node takes more than sixteen times its bytes (a strip of byte indices takes
    /// twelve). Welding takes eight times the drawn set again.
    pub fn drawing_budget(&self) -> usize {
        let decoded = self.buffers.iter().map(|buffer| match buffer {
            Buffer::Decoded(bytes) => bytes.len(),
            _ => 0,
        });
        let bytes = self.loaded_bytes.saturating_add(decoded.sum());
        bytes.saturating_mul(MOST_DRAWN).saturating_add(DRAWN_ANYWAY)
    }

    /// The number of bytes that were read in all, neighbours included, each once.
    pub(super) fn count_loaded_bytes(&self) -> usize {
        let of_buffers = self.buffers.iter().filter_map(|buffer| match buffer {
            Buffer::Data(bytes) | Buffer::Neighbour { bytes, .. } => Some(bytes),
            Buffer::Bin(_) | Buffer::Absent | Buffer::Decoded(_) => None,
        });
        let of_images = self.images.iter().filter_map(|image| match image {
            ImageFile::Data(bytes) | ImageFile::Neighbour { bytes: Some(bytes), .. } => Some(bytes),
            _ => None,
        });
        let mut counted = HashSet::new();
        let fresh = of_buffers
            .chain(of_images)
            .filter(|bytes| counted.insert(bytes.place()));
        self.file.len() + fresh.map(|bytes| bytes.len()).sum::<usize>()
    }
}
