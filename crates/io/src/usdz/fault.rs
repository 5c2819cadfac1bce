//! Reasons not to read a layer.

use crate::ReadError;

/// A reason not to read a layer.
#[derive(Debug)]
pub(super) enum Fault {
    /// It is damaged.
    Malformed(String),
    /// It needs other layers, or chooses between variants.
    Composed,
    /// It has something that is not read.
    Unsupported { feature: String, remedy: String },
    /// The caller cancelled.
    Stopped(ReadError),
}

impl From<String> for Fault {
    fn from(reason: String) -> Self {
        Self::Malformed(reason)
    }
}
