//! The options of rigid cells.

use crate::iteration::{MAX_ITERATIONS, TOLERANCE};
use crate::option::{Whole, options};

options! {
    /// Options of rigid cells.
    pub struct SpacePrimo {
        /// The approximate number of cells around the moving part.
        cells: u32 = Whole {
            default: 2000,
            range: [8, 20_000],
            help: "approximate number of cells of the space around the moving part: more cells follow the shape more \
                   closely and take longer",
        },
        /// The end of iteration.
        tolerance: f64 = TOLERANCE; advanced,
        /// The most steps.
        max_iterations: u32 = MAX_ITERATIONS; advanced,
    }
}
