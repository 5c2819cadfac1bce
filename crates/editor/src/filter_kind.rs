//! The kinds of filters of a handle's way through a sequence, and the ranges of their numbers.

use serde::{Deserialize, Serialize};

/// The effect of a filter.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", expecting = "\"smooth\" or \"exaggerate\"")]
pub enum FilterKind {
    /// Takes quick motions off.
    Smooth,
    /// Adds quick motions once more: the handle swings back before it moves, and beyond its end (the cartoon filter).
    Exaggerate,
}

/// The narrowest and the widest filter, in frames.
pub(crate) const WIDTH_RANGE: std::ops::RangeInclusive<f64> = 0.1..=1000.0;

/// The least and the largest share of a filter.
pub(crate) const AMOUNT_RANGE: std::ops::RangeInclusive<f64> = 0.0..=10.0;

impl FilterKind {
    /// The share of the quick motions that an `amount` of the filter adds.
    pub(crate) fn gain(self, amount: f64) -> f64 {
        match self {
            Self::Smooth => -amount,
            Self::Exaggerate => amount,
        }
    }
}
