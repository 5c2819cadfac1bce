//! The options of moving least squares.

use crate::option::{Choice, Number, named_choices, options};

options! {
    /// Options of moving least squares.
    pub struct Mls {
        /// The map fitted at each place.
        transforms: MlsTransforms = Choice {
            default: MlsTransforms::Rigid,
            help: "motion of each place: turns (\"rigid\"), turns and growth (\"similarity\"), or also stretch and \
                   shear (\"affine\")",
        },
        /// The falloff of a handle's influence: its weight is one over this power of the distance.
        falloff: f64 = Number {
            default: 4.0,
            range: [2.0, 8.0],
            unit: "",
            help: "power of the distance by which a handle's influence falls off: with a higher power, more of the \
                   surface around a handle moves exactly with it",
        },
    }
}

named_choices! {
    /// The transformations that moving least squares fits \[SMW06\].
    pub enum MlsTransforms {
        /// Any affine map (section 2.1).
        Affine = "affine",
        /// Rotation, uniform scale and shift (section 2.2).
        Similarity = "similarity",
        /// Rotation and shift (section 2.3).
        Rigid = "rigid",
    }
}
