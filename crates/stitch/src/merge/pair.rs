//! Vertices that belong together, and the refusal of a join.

use crate::error::StitchError;

/// Two vertices that belong together.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Pair {
    /// The vertices of A and B by the numbers that a person gave.
    pub named: [u32; 2],
    /// The same by the numbers of the parts' drawn sets; `None` for a deleted one.
    pub file: [Option<u32>; 2],
}

/// A refusal, and the part (0 for A, 1 for B) that caused it.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[error("{source}")]
pub struct MergeError {
    /// 0 or 1.
    pub part: usize,
    /// The refusal.
    pub source: StitchError,
}

impl MergeError {
    pub(super) fn of(part: usize, source: StitchError) -> Self {
        Self { part, source }
    }
}
