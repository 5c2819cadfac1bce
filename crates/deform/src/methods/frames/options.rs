//! The options of rotation-invariant coordinates.

use crate::option::{Whole, options};

options! {
    /// Options of rotation-invariant coordinates.
    pub struct Frames {
        /// The most steps after the linear solution; they descend to a minimum of the as-rigid-as-possible energy of
        /// frames that handles prescribe, and end when it is reached.
        iterations: u32 = Whole {
            default: 0,
            range: [0, 10_000],
            help: "the most steps after the linear shape, by which the surface also turns for moves; a few hundred \
                   lead to the end, and too few leave waves",
        },
    }
}
