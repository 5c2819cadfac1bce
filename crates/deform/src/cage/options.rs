//! The options of the cage.

use crate::option::{Choice, Number, Whole, named_choices, options};

options! {
    /// Options of the cage.
    pub struct Cage {
        /// How a point follows the cage.
        coordinates: CageCoordinates = Choice {
            default: CageCoordinates::MeanValue,
            help: "how points follow the cage: mean-value is quick and smooth; harmonic follows only what is near inside \
                   the cage, so that legs stay apart; green keeps angles, so that details turn and do not shear",
        },
        /// Cells of the cage along its longest side.
        detail: u32 = Whole {
            default: 6,
            range: [2, 12],
            help: "how fine the cage is: its cells along the longest side of the region",
        },
        /// Cells of the harmonic grid in one of the cage.
        grid: u32 = Whole {
            default: 5,
            range: [5, 10],
            help: "how fine the grid of harmonic coordinates is: its cells along one cell of the cage",
        }; advanced,
        /// Where the field fades towards what is fixed.
        falloff: f64 = Number {
            default: 0.1,
            range: [0.0, 1.0],
            unit: "diagonals of the region",
            help: "how far from what is fixed the deformation fades in",
        },
    }
}

named_choices! {
    /// The coordinates of points in a cage.
    pub enum CageCoordinates {
        /// Of \[JSW05\]: defined everywhere, negative in places.
        MeanValue = "mean-value",
        /// Of [JMD+07]: never negative, by a solve on a grid inside the cage.
        Harmonic = "harmonic",
        /// Of \[LLC08\]: with the normals of the faces, so that they keep angles.
        Green = "green",
    }
}
