//! The options of Laplacian editing.

use crate::option::{Choice, Whole, named_choices, options};

options! {
    /// Options of Laplacian editing.
    pub struct LaplacianEditing {
        /// The source of each vertex' transformation of its differential coordinate.
        transforms: Transforms = Choice {
            default: Transforms::Implicit,
            help: "turns of details: those of the new shape (\"implicit\"), those of a first shape solved without \
                   turns (\"initial-guess\"), or none (\"none\")",
        },
        /// The treatment of the scale of implicit transformations.
        scale: LocalScale = Choice {
            default: LocalScale::Normalised,
            help: "size of details: kept (\"normalised\"), or growing with a pulled surface (\"free\")",
        },
        /// The distance in edges of the neighbours from which transformations are estimated; implicit ones use 1 first.
        ring: u32 = Whole {
            default: 1,
            range: [1, 5],
            help: "width in edges of the neighbourhoods from which turns are estimated: wide ones are smoother",
        }; advanced,
        /// The number of parts into which the handles' motion is divided.
        steps: u32 = Whole {
            default: 1,
            range: [1, 100],
            help: "number of steps into which the handles' motion is divided: one for each 90° of their turn",
        },
    }
}

named_choices! {
    /// The transformations T_i in L M⁻¹ L p' = L M⁻¹ T (L p).
    pub enum Transforms {
        /// Similarities, linearised, fitted to the neighbours' unknown positions during the solve [SCL+04; BS08,
        /// section 3.2.6].
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
        /// Only their rotations are used.
        Normalised = "normalised",
        /// They keep the fitted scale.
        Free = "free",
    }
}
