//! The options of rotation-invariant coordinates.

use crate::option::{Whole, options};

options! {
    /// Options of rotation-invariant coordinates.
    pub struct Frames {
        /// The number of iterations after the linear solution; each fits the frames to the positions and the positions
        /// to the frames. The energy never rises, and its fixed point is a minimum of the as-rigid-as-possible energy
        /// of frames that handles prescribe.
        iterations: u32 = Whole {
            default: 0,
            range: [0, 10_000],
            help: "number of steps that fit frames and positions in turn after the linear shape: with a few dozen the \
                   surface also turns for moves",
        },
    }
}
