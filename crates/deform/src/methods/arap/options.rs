//! The options of ARAP.

use crate::iteration;
use crate::option::{Choice, Number, named_choices, options};

options! {
    /// Options of the as-rigid-as-possible method.
    pub struct Arap {
        /// The edges of a vertex's cell.
        energy: ArapEnergy = Choice {
            default: ArapEnergy::SpokesAndRims,
            help: "the shape that a neighbourhood keeps: its vertex's edges (\"spokes\"), its triangles \
                   (\"spokes-and-rims\", quick, for folds and creases), or its triangles and their bending \
                   (\"smooth\", for even bends and twists and for handles of single points)",
        }; advanced,
        /// κ of the smooth energy (see [`ArapEnergy::Smooth`]), which bends like ½ κ A ∫ |Hess p'|², A being the area
        /// of the surface that can move: it has no unit and is independent of the mesh's size and density. Other
        /// energies ignore it.
        smoothness: f64 = Number {
            default: 0.003,
            // From hardly smoother than the rims alone to nearly a thin plate that keeps its curvature.
            range: [1e-6, 10.0],
            unit: "",
            help: "resistance of the energy \"smooth\" to bending, independent of the mesh's size and density",
        }; only_with("energy", &["smooth"]),
        /// Iteration ends when a step lowers the energy by less than this share of it; above 0.
        tolerance: f64 = iteration::TOLERANCE; advanced,
        /// Iteration ends after this many steps towards one set of targets, converged or not; at least 1.
        max_iterations: u32 = iteration::MAX_ITERATIONS; advanced,
    }
    beside {
        /// With more solved vertices than this a coarse level leads: it predicts the shape for new targets and speeds
        /// up convergence, to the same minimum. With fewer, steps are fast enough without it: at 10k vertices both take
        /// the same time.
        coarse_above: usize = 20_000,
    }
}

named_choices! {
    /// The edges of an ARAP cell.
    #[non_exhaustive]
    pub enum ArapEnergy {
        /// The edges from its vertex to the neighbours \[SA07\], negative weights floored.
        Spokes = "spokes",
        /// All edges of its vertex's triangles \[CPSS10\], with plain cotangents; never negative.
        SpokesAndRims = "spokes-and-rims",
        /// Spokes and rims, with every cell tied to its own affine map: a thin plate that bumps and free borders do not
        /// disturb, with the aim of \[LG15\] and \[OHS25\]. Handles of a single vertex make no spikes; twists spread
        /// evenly, and a barrier keeps necks from being pinched by them.
        Smooth = "smooth",
    }
}

impl Arap {
    /// The window's initial method: the smooth energy, which bends and twists evenly.
    pub fn first_choice() -> Self {
        Self {
            energy: ArapEnergy::Smooth,
            ..Self::default()
        }
    }

    /// The power of the Laplacian whose graph the system has.
    pub fn operator_power(&self) -> u32 {
        match self.energy {
            ArapEnergy::Spokes | ArapEnergy::SpokesAndRims => 1,
            ArapEnergy::Smooth => 2,
        }
    }
}
