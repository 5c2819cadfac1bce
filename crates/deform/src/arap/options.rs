//! What can be chosen.

/// Options of the as-rigid-as-possible method.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct Arap {
    /// Which edges a vertex's cell consists of.
    pub energy: ArapEnergy,
    /// κ of the smooth energy (see [`ArapEnergy::Smooth`]), which bends like ½ κ A ∫ |Hess p'|², A being the area of what
    /// can move: without unit and independent of the mesh's size and density, within [`Arap::SMOOTHNESS`]. Other energies
    /// have no use for it.
    pub smoothness: f64,
    /// Iteration ends where a step lowers the energy by less than this share of it; above 0.
    pub tolerance: f64,
    /// Iteration ends after so many steps towards one set of targets, converged or not; at least 1.
    pub max_iterations: u32,
    /// With more vertices to solve for than this a coarse level leads: it goes ahead for new targets and corrects the way
    /// to the end, which stays a minimum of the whole energy. Below, the steps are quick enough without: at 10k vertices
    /// both ways take as long.
    pub coarse_above: usize,
}

impl Arap {
    /// From hardly smoother than the rims alone to nearly a plate that keeps its curvature.
    pub const SMOOTHNESS: std::ops::RangeInclusive<f64> = 1e-6..=10.0;

    /// The power of the Laplacian whose graph the system has.
    pub fn operator_power(&self) -> u32 {
        match self.energy {
            ArapEnergy::Spokes | ArapEnergy::SpokesAndRims => 1,
            ArapEnergy::Smooth => 2,
        }
    }
}

impl Default for Arap {
    fn default() -> Self {
        Self {
            energy: ArapEnergy::default(),
            smoothness: 0.003,
            tolerance: 1e-7,
            max_iterations: 1000,
            coarse_above: 20_000,
        }
    }
}

/// Which edges an ARAP cell consists of.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[non_exhaustive]
pub enum ArapEnergy {
    /// Those from its vertex to the neighbours (Sorkine & Alexa 2007), negative weights floored.
    Spokes,
    /// All edges of its vertex's triangles (Chao et al. 2010), with plain cotangents; never negative.
    #[default]
    SpokesAndRims,
    /// Spokes and rims, and every cell held to an affine map of its own: a thin plate in which neither bumps nor free
    /// borders tell, for what Levi & Gotsman (2015) and Oehri et al. (2025) smooth. No spikes at handles of a single
    /// vertex; twists spread evenly.
    Smooth,
}

impl ArapEnergy {
    /// All, in the order in which they are shown.
    pub const ALL: [Self; 3] = [Self::Spokes, Self::SpokesAndRims, Self::Smooth];

    /// Its name in the edit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Spokes => "spokes",
            Self::SpokesAndRims => "spokes-and-rims",
            Self::Smooth => "smooth",
        }
    }
}
