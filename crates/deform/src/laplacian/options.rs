//! The options of Laplacian editing.

use crate::method::option::{Choice, Whole, named_choices, options};

options! {
    /// Options of Laplacian editing.
    pub struct LaplacianEditing {
        /// Where each vertex' transformation of its differential coordinate comes from.
        transforms: Transforms = Choice {
            default: Transforms::Implicit,
            help: "how details turn: as the new shape asks (\"implicit\"), as a first shape without turns asks \
                   (\"initial-guess\"), or not at all (\"none\")",
        },
        /// What becomes of the scale of implicit transformations.
        scale: LocalScale = Choice {
            default: LocalScale::Normalised,
            help: "whether details keep their size (\"normalised\") or grow where the surface is pulled (\"free\")",
        },
        /// How many edges away the neighbours lie from which transformations are estimated; implicit ones take 1 first.
        ring: u32 = Whole {
            default: 1,
            range: [1, 5],
            help: "how many edges wide the neighbourhoods are from which turns are estimated: wide ones are smoother",
        }; advanced,
        /// Into how many parts the handles' motion is divided.
        steps: u32 = Whole {
            default: 1,
            range: [1, 100],
            help: "into how many steps the handles' way is divided: one for each 90° of their turn",
        },
    }
}

named_choices! {
    /// The transformations T_i in L M⁻¹ L p' = L M⁻¹ T (L p).
    pub enum Transforms {
        /// Similarities, linearised, fitted to the neighbours' unknown positions while these are solved for [SCL+04;
        /// BS08, section 3.2.6].
        Implicit = "implicit",
        /// Rotations fitted to the solution with T = 1 [LSC+04; BS08, section 3.2.5].
        InitialGuess = "initial-guess",
        /// T = 1: details keep their direction in space.
        None = "none",
    }
}

named_choices! {
    /// The scale of the transformations.
    pub enum LocalScale {
        /// Their rotations alone count.
        Normalised = "normalised",
        /// They scale as they were fitted.
        Free = "free",
    }
}
