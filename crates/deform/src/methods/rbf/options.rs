//! The options of radial basis functions.

use crate::option::{Number, Whole, options};

options! {
    /// Options of radial basis functions.
    pub struct Rbf {
        /// The tolerance with which the field meets handles and fixed vertices.
        tolerance: f64 = Number {
            default: 1e-4,
            range: [1e-9, 0.1],
            unit: "",
            help: "the largest error at the constraints, as a share of the handles' motion: centres are added until \
                   it is met",
        }; advanced,
        /// The most centres.
        centres: u32 = Whole {
            default: 1500,
            range: [8, 5000],
            help: "the largest number of centres, which are chosen among the constraints",
        }; advanced,
    }
}
