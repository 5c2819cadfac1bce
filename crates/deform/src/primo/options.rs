//! What can be chosen.

use crate::method::iteration;
use crate::method::option::{Number, options};

options! {
    /// Options of the coupled prisms.
    pub struct Primo {
        /// The prisms' height, in diagonals of the surface's bounding box. What a thick surface resists most is being
        /// bent, what a thin one resists most is being stretched. The same value means the same material whatever the
        /// mesh's density.
        thickness: f64 = Number {
            default: 0.05,
            range: [0.001, 1.0],
            unit: "diagonals",
            help: "the prisms' height, in diagonals of the model: how much bending is resisted against stretching",
        },
        /// Iteration ends where a step lowers the energy by less than this share of it; above 0.
        tolerance: f64 = iteration::TOLERANCE,
        /// Iteration ends after so many steps towards one set of targets, converged or not; at least 1.
        max_iterations: u32 = iteration::MAX_ITERATIONS,
    }
}
