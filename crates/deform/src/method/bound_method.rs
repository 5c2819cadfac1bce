//! A bound method.

use std::fmt::Debug;
use std::sync::Arc;

use glam::{DVec3, Mat3};
use pliant_mesh::Cancel;

use crate::handles::Motion;
use crate::handles::controls::Controls;
use crate::handles::finite::Finite;
use crate::handles::offsets::Offsets;
use crate::{HandleBases, ReusableFactor, SolveError, Warning};

/// A bound method: motions of the handles in, displacements out.
///
/// `motions` has one entry per handle, `displacements` one per surface vertex. At least one handle moves, a person has
/// moved a control point, or the weight of an example is set and not 0.
pub(crate) trait BoundMethod: Debug + Send + Sync {
    /// One step: fills *all* of `displacements`, handles' vertices and zeros included.
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError>;

    /// Like `step`, but without the step's shortcut.
    fn step_by_back_substitution(
        &mut self,
        motions: &[Motion],
        displacements: &mut [DVec3],
    ) -> Result<Stepped, SolveError> {
        self.step(motions, displacements)
    }

    /// Sets the flag that ends a step which only settles a shape: once it is raised, the step returns with the shape
    /// that it has reached.
    fn set_cancel(&mut self, _cancel: &Cancel) {}

    /// Called when all handles are back at rest: the next step begins at rest.
    fn rest(&mut self) {}

    /// Begins the descent to the targets that were just set at a shape, if that is lower than the method's own start.
    /// Returns whether the method takes such a start.
    fn begin_at(&mut self, _motions: &[Motion], _displacements: &[DVec3]) -> bool {
        false
    }

    /// The energy of any displacements, if the energy is a function of the vertices.
    fn energy_of(&self, _motions: &[Motion], _displacements: &[DVec3]) -> Option<f64> {
        None
    }

    /// Fills in a handle's weight at each surface vertex, from 0 to 1, if the method spreads the handle's effect by
    /// weights; `weights` are zeros. Returns whether it does.
    fn weights_of(&self, _handle: usize, _weights: &mut [f64]) -> bool {
        false
    }

    /// Replaces the surface's displacements by those that take its vertices to the smooth base, as the last step has
    /// bent it, if the method bends one and puts the details back on it. Returns whether it does. Only linear methods
    /// may.
    fn base(&self, _displacements: &mut [DVec3]) -> bool {
        false
    }

    /// Fills in the Jacobian of the displacements at each surface vertex, in the last step, if the method knows its
    /// map's derivative: the inverse transpose of I plus it then turns the normals. Returns whether it does.
    fn jacobians(&self, _motions: &[Motion], _out: &mut [Mat3]) -> bool {
        false
    }

    /// The handles' bases, if a step is a product with them.
    fn handle_bases(&self) -> Option<&HandleBases> {
        None
    }

    /// The system, if a frame is one back-substitution with it.
    fn system(&self) -> Option<&dyn FactoredSystem> {
        None
    }

    /// The factor, if the next binding can reuse parts of it.
    fn reusable_factor(&self) -> Option<ReusableFactor> {
        self.system().map(FactoredSystem::reusable_factor)
    }

    /// Its control points, if it has some.
    fn controls(&self) -> Option<&Controls> {
        None
    }

    /// The same, to be moved by hand.
    fn controls_mut(&mut self) -> Option<&mut Controls> {
        None
    }

    /// The positions of its control points for these motions of the handles.
    fn control_positions(&self, motions: &[Motion]) -> Vec<DVec3> {
        self.controls()
            .map(|controls| controls.positions(motions))
            .unwrap_or_default()
    }

    /// Sets the offsets of handles' vertices from their handles' motions, for a method that
    /// [takes places](super::DeformMethod::takes_places). The next step has new targets then.
    fn set_offsets(&mut self, _offsets: &Arc<Offsets>) {}

    /// Sets the weights of the brought examples, `None` for one to be found.
    fn set_weights(&mut self, _weights: &[Option<f64>]) {}

    /// The weights of these examples in the last step.
    fn weights(&self) -> &[f64] {
        &[]
    }

    /// The number of solved vertices.
    fn solved_count(&self) -> usize;

    /// The number of entries that its factors store, 8 bytes each.
    fn factor_len(&self) -> usize {
        self.system().map_or(0, FactoredSystem::factor_len)
    }

    /// The approximate cost of a step, in vertices of a method whose step is a product.
    fn step_cost(&self) -> usize {
        let of_back_substitution = if self.system().is_some() { 4 } else { 1 };
        of_back_substitution * self.solved_count()
    }

    /// Sentences about repairs.
    fn warnings(&self) -> Vec<String> {
        self.system().map(FactoredSystem::warnings).unwrap_or_default()
    }

    /// Sentences about the last step's shape.
    fn faults(&self) -> Vec<String> {
        Vec::new()
    }

    /// Sentences about motions that the method can't follow.
    fn blind_to(&self, _motions: &[Motion]) -> Vec<Warning> {
        Vec::new()
    }
}

/// A factored system that several methods share.
pub(crate) trait FactoredSystem {
    /// The data that the next binding can reuse.
    fn reusable_factor(&self) -> ReusableFactor;

    /// The number of entries that the factor stores.
    fn factor_len(&self) -> usize;

    /// Sentences about repairs.
    fn warnings(&self) -> Vec<String>;
}

/// The result of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stepped {
    /// True if further steps to the same motions would change nothing, and the shape is a minimum.
    pub converged: bool,
    /// True if further steps would change nothing although the shape is no minimum: no step was found that lowers the
    /// energy.
    pub stalled: bool,
    /// See [`crate::Step::energy`].
    pub energy: f64,
    /// The finiteness of all displacements, if it was checked while they were computed.
    pub finite: Finite,
}

impl Stepped {
    /// The only step of a direct method, after which further steps to the same motions change nothing.
    pub(crate) fn at_once(energy: f64, finite: Finite) -> Self {
        Self {
            converged: true,
            stalled: false,
            energy,
            finite,
        }
    }
}
