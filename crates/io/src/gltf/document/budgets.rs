//! What a glTF may become in memory: a multiple of the bytes that were read.

use std::collections::HashSet;

use super::Document;
use super::buffers::{Buffer, ImageFile};

/// How many bytes of geometry a byte of the file may become.
const MOST_GROWTH: usize = 64;

/// How many bytes of the drawn set a byte of geometry may become.
const MOST_DRAWN: usize = 16;

/// What the drawn set of the smallest of files may take: five million triangles.
const DRAWN_ANYWAY: usize = 64 << 20;

/// What compressed geometry may become in the smallest of files.
const DECODED_ANYWAY: usize = 1 << 20;

impl Document {
    /// How many bytes compressed geometry may become in all.
    pub fn decoding_budget(&self) -> usize {
        self.loaded_bytes.saturating_mul(MOST_GROWTH).max(DECODED_ANYWAY)
    }

    /// How many bytes of memory the drawn set may take: what the bytes justify, and small files with many instances.
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

    /// How many bytes were read in all, neighbours included, each once.
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
