//! A problem bound to a method: new transforms in, displacements out.

use glam::{DAffine3, DVec3};
use pliant_mesh::{Cancel, Progress};

use crate::{BindError, HandleBases, Ordering, Problem, SolveError};

/// A bound problem: everything that does not depend on the handles' transforms is solved.
#[derive(Debug)]
pub struct Bound {
    revision: u64,
}

/// What one step did.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Step {
    /// Whether further steps to the same targets would change nothing. Linear methods: always.
    pub converged: bool,
    /// The deformation energy, 0 at rest; for the thin plate ½ dᵀ L M⁻¹ L d, without unit (it does not change with
    /// the model's scale).
    pub energy: f64,
    /// How many steps were taken towards these targets, this one included.
    pub iteration: u32,
}

impl Bound {
    pub(crate) fn bind(problem: &Problem, ordering: &Ordering, progress: &Progress, cancel: &Cancel) -> Result<Self, BindError> {
        let _ = (problem, ordering, progress, cancel);
        unimplemented!()
    }
    /// Sets where the handles are to go: one affine map of world positions a handle, from rest.
    ///
    /// # Errors
    /// A wrong count, or a transform that is not finite; the former targets stay then.
    pub fn set_targets(&mut self, world_targets: &[DAffine3]) -> Result<(), SolveError> {
        let _ = world_targets;
        unimplemented!()
    }
    /// One step towards the targets: fills `displacements`, one a surface vertex, in world units.
    ///
    /// # Errors
    /// A wrong length, or a result that is not finite; `displacements` is all zero then.
    pub fn step(&mut self, displacements: &mut [DVec3]) -> Result<Step, SolveError> {
        let _ = displacements;
        unimplemented!()
    }
    /// As [`Bound::step`], but by solving with the factor in f64 instead of using the handles' bases.
    pub fn step_by_back_substitution(&mut self, displacements: &mut [DVec3]) -> Result<Step, SolveError> {
        let _ = displacements;
        unimplemented!()
    }
    /// The handles' bases, where the method is linear.
    pub fn handle_bases(&self) -> Option<&HandleBases> {
        unimplemented!()
    }
    /// The energy of the rest shape, as in [`Step::energy`].
    pub fn energy_rest(&self) -> f64 {
        0.0
    }
    /// Sentences for a person: what components do, what was repaired.
    pub fn warnings(&self) -> &[String] {
        &[]
    }
    /// How many vertices are free to move.
    pub fn free_count(&self) -> usize {
        0
    }
    /// [`Problem::revision`] of the problem it was bound from.
    pub fn revision(&self) -> u64 {
        self.revision
    }
}
