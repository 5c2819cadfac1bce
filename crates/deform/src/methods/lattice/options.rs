//! The options of the lattice.

use crate::option::{Choice, Number, Whole, named_choices, options};

/// The help of one axis' resolution.
const fn of_axis(help: &'static str) -> Whole {
    Whole {
        default: 0,
        range: [0, 10],
        help,
    }
}

options! {
    /// Options of the lattice.
    pub struct Lattice {
        /// Cells along each axis.
        resolution: u32 = Whole {
            default: 4,
            range: [1, 10],
            help: "cells of the lattice along each axis; more follow the handles more closely and bend more locally",
        },
        /// Cells along x, instead of `resolution`.
        resolution_x: u32 = of_axis("cells along x, or 0 to use `resolution`"),
        /// Cells along y, instead of `resolution`.
        resolution_y: u32 = of_axis("cells along y, or 0 to use `resolution`"),
        /// Cells along z, instead of `resolution`.
        resolution_z: u32 = of_axis("cells along z, or 0 to use `resolution`"),
        /// The functions that weight the control points.
        basis: LatticeBasis = Choice {
            default: LatticeBasis::BSpline,
            help: "functions of the control points: with b-spline a point moves its surroundings; with bernstein it \
                   moves everything a little",
        },
        /// The degree of B-splines.
        degree: u32 = Whole {
            default: 3,
            range: [1, 3],
            help: "smoothness of b-splines: 1 has creases, 2 has continuous tangents, 3 has continuous curvature; \
                   bernstein's degree is the resolution",
        }; advanced,
        /// The criterion if the handles leave a choice.
        norm: LatticeNorm = Choice {
            default: LatticeNorm::Bending,
            help: "choice among lattices that fit the handles equally well: the one that bends least, or \
                   (\"displacement\") the one that moves least, which stays close to the handles",
        }; advanced,
        /// The fading of the field towards fixed vertices.
        falloff: f64 = Number {
            default: 0.1,
            range: [0.0, 1.0],
            unit: "diagonals of the region",
            help: "distance from the fixed part over which the deformation fades in",
        },
    }
}

/// The cells with which a person begins: 3 × 4 × 3 points.
const FEW: [u32; 3] = [2, 3, 2];

impl Lattice {
    /// The options with which a person begins, who sees and moves the points: few of them, and all on the box. Those of
    /// B-splines lie beyond it and hardly move anything there.
    pub(super) fn first_choice() -> Self {
        let [resolution_x, resolution_y, resolution_z] = FEW;
        Self {
            basis: LatticeBasis::Bernstein,
            resolution_x,
            resolution_y,
            resolution_z,
            ..Self::default()
        }
    }
}

named_choices! {
    /// The functions of a lattice.
    pub enum LatticeBasis {
        /// Uniform B-splines of the option `degree`.
        BSpline = "b-spline",
        /// Bernstein polynomials, of a degree equal to the number of cells.
        Bernstein = "bernstein",
    }
}

named_choices! {
    /// The choice among the lattices that fit the handles equally well.
    pub enum LatticeNorm {
        /// The one with the least second differences of the control points.
        Bending = "bending",
        /// The one whose control points move least \[HHK92\].
        Displacement = "displacement",
    }
}
