//! The options of discrete shells.

use crate::iteration::{MAX_ITERATIONS, TOLERANCE};
use crate::option::{Number, options};

options! {
    /// Options of discrete shells.
    pub struct Shells {
        /// k_s: the resistance of the surface to stretching, without unit. Only its ratios to the other two count.
        stretching: f64 = Number {
            default: 1.0,
            range: [1e-3, 1e3],
            unit: "",
            help: "resistance to stretching and shearing, compared with the other two",
        },
        /// k_b: the resistance to bending, in units of `stretching` times the squared size of the bending region. A
        /// sheet of the thickness t has about k_b = k_s (t / D)² / 48.
        bending: f64 = Number {
            default: 1e-4,
            range: [1e-8, 0.1],
            unit: "squared sizes of stretching",
            help: "resistance to bending: little for paper, which creases, much for thick rubber",
        },
        /// k_v: the resistance of closed parts to a change of their volume, without unit; with 0 the volume is free.
        volume: f64 = Number {
            default: 0.0,
            range: [0.0, 1e6],
            unit: "",
            help: "resistance of closed parts to a change of their volume, compared with stretching; 1000 keeps it",
        },
        /// Iteration ends at this tolerance.
        tolerance: f64 = TOLERANCE; advanced,
        /// The most steps.
        max_iterations: u32 = MAX_ITERATIONS; advanced,
    }
    beside {
        /// With more solved vertices than this a coarse level leads; with fewer, every step is a Newton step of the
        /// whole surface.
        led_above: usize = 10_000,
    }
}

impl Shells {
    /// The `bending` of paper, which keeps its lengths and creases, and of thick rubber, which bends evenly and
    /// stretches instead. The default is the middle of their logarithms.
    pub const PAPER_TO_RUBBER: [f64; 2] = [1e-6, 1e-2];
}
