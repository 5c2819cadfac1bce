//! The options of the cage.

use crate::option::{Choice, Number, Whole, named_choices, options};

options! {
    /// Options of the cage.
    pub struct Cage {
        /// The coordinates by which a point follows the cage.
        coordinates: CageCoordinates = Choice {
            default: CageCoordinates::MeanValue,
            help: "coordinates of points in the cage: mean-value is quick and smooth; harmonic follows only the near \
                   parts inside the cage, so that legs stay apart; green keeps angles, so that details turn and do \
                   not shear",
        },
        /// The number of cells of the cage along its longest side.
        detail: u32 = Whole {
            default: 6,
            range: [2, 12],
            help: "fineness of the cage: its cells along the longest side of the region",
        },
        /// The number of cells of the harmonic grid in one cell of the cage.
        grid: u32 = Whole {
            default: 5,
            range: [5, 10],
            help: "fineness of the grid of harmonic coordinates: its cells along one cell of the cage",
        }; advanced,
        /// The distance over which the field fades towards fixed vertices.
        falloff: f64 = Number {
            default: 0.1,
            range: [0.0, 1.0],
            unit: "diagonals of the region",
            help: "distance from the fixed part over which the deformation fades in",
        },
    }
}

named_choices! {
    /// The coordinates of points in a cage.
    pub enum CageCoordinates {
        /// Mean value coordinates \[JSW05\]: defined everywhere, negative in places.
        MeanValue = "mean-value",
        /// Harmonic coordinates [JMD+07]: never negative, by a solve on a grid inside the cage.
        Harmonic = "harmonic",
        /// Green coordinates \[LLC08\]: they use the normals of the faces and so keep angles.
        Green = "green",
    }
}
