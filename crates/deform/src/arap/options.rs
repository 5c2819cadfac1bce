//! What can be chosen.

/// Options of the as-rigid-as-possible method.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct Arap {
    /// Which edges a vertex's cell consists of.
    pub energy: ArapEnergy,
    /// Iteration ends where a step lowers the energy by less than this share of it; above 0.
    pub tolerance: f64,
    /// Iteration ends after so many steps towards one set of targets, converged or not; at least 1.
    pub max_iterations: u32,
}

impl Default for Arap {
    fn default() -> Self {
        Self {
            energy: ArapEnergy::default(),
            tolerance: 1e-4,
            max_iterations: 500,
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
}

impl ArapEnergy {
    /// All, in the order in which they are shown.
    pub const ALL: [Self; 2] = [Self::Spokes, Self::SpokesAndRims];

    /// Its name in the edit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Spokes => "spokes",
            Self::SpokesAndRims => "spokes-and-rims",
        }
    }
}
