//! The result of a step.

/// The result of one step.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Step {
    /// True if further steps to the same targets would change nothing. Linear methods: always.
    pub converged: bool,
    /// True if further steps to the same targets do nothing: it converged, found no lower energy, or met the method's
    /// limit.
    pub finished: bool,
    /// The deformation energy, 0 at rest, without unit and independent of the model's scale. For the bi-Laplacian it is
    /// ½ dᵀ A d (see [`crate::Bilaplacian`]) and the energy of the soft handles' springs; for ARAP its own energy and
    /// its springs', divided by ½ Σ w |e|² of the rest shape; for gradient editing likewise. Components without a
    /// handle are left out.
    pub energy: f64,
    /// The number of steps taken towards these targets, this one included.
    pub iteration: u32,
    /// The largest distance of a hard handle's vertex from its target by the handle's transform, in world units: 0 for
    /// every method that holds handles exactly.
    pub handle_residual: f64,
    /// True if the step tried another place of a free handle, so that the displacements are those of an earlier step.
    pub is_trial: bool,
}
