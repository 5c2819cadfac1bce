//! What can be chosen.

/// Options of the coupled prisms.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct Primo {
    /// The prisms' height, in diagonals of the surface's bounding box, 0.001 to 1. What a thick surface resists most is
    /// being bent, what a thin one resists most is being stretched. The same value means the same material whatever the
    /// mesh's density.
    pub thickness: f64,
    /// Iteration ends where a step lowers the energy by less than this share of it; above 0.
    pub tolerance: f64,
    /// Iteration ends after so many steps towards one set of targets, converged or not; at least 1.
    pub max_iterations: u32,
}

impl Default for Primo {
    fn default() -> Self {
        Self {
            thickness: 0.05,
            tolerance: 1e-7,
            max_iterations: 1000,
        }
    }
}
