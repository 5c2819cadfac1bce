//! The options of embedded deformation.

use crate::iteration::{MAX_ITERATIONS, TOLERANCE};
use crate::option::{Whole, options};

options! {
    /// Options of embedded deformation.
    pub struct Embedded {
        /// The number of nodes on the moving part.
        nodes: u32 = Whole {
            default: 300,
            range: [4, 1000],
            help: "number of nodes on the moving part: more nodes bend in more places and take longer",
        },
        /// The end of iteration.
        tolerance: f64 = TOLERANCE; advanced,
        /// The most steps.
        max_iterations: u32 = MAX_ITERATIONS; advanced,
    }
}
