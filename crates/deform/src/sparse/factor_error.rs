//! Why a factorisation came to nothing.

/// Why there is no factor.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum FactorError {
    /// The pivot of this column is not above zero.
    Pivot(usize),
    /// Too large for the machine or for the index type.
    Memory,
    /// Somebody raised the flag.
    Cancelled,
}
