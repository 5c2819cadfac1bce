//! Why a factorisation failed.

use std::collections::TryReserveError;

use crate::budget::Limit;

/// Why there is no factor.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum FactorError {
    /// The pivot of this column is not above zero.
    Pivot(usize),
    /// Too large for the machine or for the index type.
    Memory,
    /// It takes more than the budget has left.
    Budget(Limit),
    /// Somebody raised the flag.
    Cancelled,
}

impl From<TryReserveError> for FactorError {
    fn from(_: TryReserveError) -> Self {
        Self::Memory
    }
}

impl From<Limit> for FactorError {
    fn from(limit: Limit) -> Self {
        Self::Budget(limit)
    }
}
