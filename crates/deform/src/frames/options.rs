//! The options of rotation-invariant coordinates.

use crate::option::{Whole, options};

options! {
    /// Options of rotation-invariant coordinates.
    pub struct Frames {
        /// How often frames are fitted to the positions and positions to the frames, after the linear solution. The
        /// energy never rises, and its fixed point is a minimum of the as-rigid-as-possible energy of frames that
        /// handles prescribe.
        iterations: u32 = Whole {
            default: 0,
            range: [0, 10_000],
            help: "how often the linear shape is improved by fitting frames and positions in turn: with some dozens the \
                   surface turns for moves too",
        },
    }
}
