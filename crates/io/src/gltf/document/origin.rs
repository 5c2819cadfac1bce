//! The origins of a glTF's bytes.

use std::ops::Range;

use crate::Bytes;

/// A buffer's bytes and their origin.
#[derive(Debug)]
pub(crate) enum Buffer {
    /// The GLB's BIN chunk: a range of the file.
    Bin(Range<usize>),
    /// A data URI.
    Data(Bytes),
    /// A file beside this one, by its decoded path.
    Neighbour { path: String, bytes: Bytes },
    /// None: a placeholder that an extension fills.
    Absent,
    /// The decoded bytes of a compressed buffer view or accessor: not a buffer of the file. These come after the file's
    /// own.
    Decoded(Bytes),
}

/// An image's bytes and their origin.
#[derive(Debug)]
pub(crate) enum ImageFile {
    /// A buffer view.
    View(usize),
    /// A data URI.
    Data(Bytes),
    /// A file beside this one, by its decoded path; no bytes if it is missing.
    Neighbour { path: String, bytes: Option<Bytes> },
    /// A place that is not read.
    Absent,
}
