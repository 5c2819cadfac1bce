//! The options of wrinkles.

use crate::Bilaplacian;
use crate::methods::bilaplacian::STRETCHING;
use crate::option::{Whole, options};

options! {
    /// Options of wrinkles learnt from examples.
    pub struct Wrinkles {
        /// k_s of the bi-Laplacian, as in [`Bilaplacian::stretching`].
        stretching: f64 = STRETCHING,
        /// The number of samples of the bending part that measure its strain.
        samples: u32 = Whole {
            default: 200,
            range: [4, 5000],
            help: "number of places at which the strain is measured: with more places, wrinkles depend on nearer \
                   strain",
        }; advanced,
    }
}

impl Wrinkles {
    /// The bi-Laplacian that bends the coarse shape.
    pub(super) fn bending(&self) -> Bilaplacian {
        Bilaplacian {
            stretching: self.stretching,
            ..Bilaplacian::default()
        }
    }
}
