//! The options of the coupled prisms.

use crate::iteration;
use crate::option::{Number, options};

options! {
    /// Options of the coupled prisms.
    pub struct Primo {
        /// The prisms' height, in sizes of the bending part. A thick surface resists bending most, a thin one
        /// stretching. The same value means the same material for any density of the mesh.
        thickness: f64 = Number {
            default: 0.1,
            range: [0.001, 1.0],
            unit: "sizes of the bending part",
            help: "the prisms' height, in sizes of the bending part (a rod's length, a ball's diagonal): a large \
                   height resists bending most, a small one stretching",
        },
        /// Iteration ends when a step lowers the energy by less than this share of it; above 0.
        tolerance: f64 = iteration::TOLERANCE; advanced,
        /// Iteration ends after this many steps towards one set of targets, converged or not; at least 1.
        max_iterations: u32 = iteration::MAX_ITERATIONS; advanced,
    }
}
