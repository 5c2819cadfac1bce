//! Options of all iterative methods.

use super::option::{Number, Whole};

/// The relative decrease of the energy below which iteration ends.
pub(crate) const TOLERANCE: Number = Number {
    default: 1e-7,
    range: [1e-12, 0.1],
    unit: "of the energy",
    help: "iteration ends when a step lowers the energy by less than this share of it",
};

/// The most steps.
pub(crate) const MAX_ITERATIONS: Whole = Whole {
    default: 1000,
    range: [1, 100_000],
    help: "iteration ends after this many steps a frame",
};
