//! Reasons why a factorisation failed.

use std::collections::TryReserveError;

use crate::budget::Limit;

/// The reason why there is no factor.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum FactorError {
    /// The pivot of this column is not positive.
    Pivot(usize),
    /// Too large for the machine or for the index type.
    Memory,
    /// The factorisation exceeds the remaining budget.
    Budget(Limit),
    /// It was cancelled.
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
