//! The traits that each method implements: one for its options, one for its bound form.

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use glam::{DVec3, Mat3};
use pliant_mesh::{Cancel, Progress};

use super::{
    Attachment, AttachmentRefused, ControlLattice, MethodDeclaration, Needs, OptionRefused, OptionValue, Solve,
};
use crate::handles::offsets::Offsets;
use crate::handles::turns::Followed;
use crate::handles::{Handle, Motion};
use crate::operators::triangulation::Triangulation;
use crate::region::partition::Partition;
use crate::space::controls::Controls;
use crate::sparse::refactorisation::Refactorisation;
use crate::{BindError, HandleBases, Ordering, Problem, ReusableFactor, SolveError, Warning};

/// Options by name; [`super::option::options!`] implements it.
pub(crate) trait Options: Any + Debug + Send + Sync {
    /// The value of an option; `None` if there is none of this name.
    fn value(&self, option: &str) -> Option<OptionValue>;

    /// Sets an option without checking its range; `None` if there is none of this name and kind.
    fn set(&mut self, option: &str, value: OptionValue) -> Option<()>;

    /// A copy.
    fn boxed_clone(&self) -> Box<dyn DeformMethod>;

    /// Whether `other` is the same method with the same options.
    fn equals(&self, other: &dyn DeformMethod) -> bool;
}

/// A method: its options, and their binding.
pub(crate) trait DeformMethod: Options {
    /// Its declaration.
    fn declaration(&self) -> &'static MethodDeclaration;

    /// Its domain.
    fn needs(&self) -> Needs;

    /// The way in which it is solved once it is bound.
    fn solve(&self) -> Solve;

    /// Refuses options that exclude each other. The range of each option was checked before.
    fn check(&self) -> Result<(), OptionRefused> {
        Ok(())
    }

    /// The rest positions of a lattice's control points, for a method with a lattice.
    fn lattice_points(&self, _lattice: &ControlLattice) -> Vec<DVec3> {
        Vec::new()
    }

    /// Refuses an attachment of a declared kind that can't be bound with these options to any surface. Its table
    /// `moved` and non-finite values are checked afterwards.
    fn check_attachment(&self, _attachment: &Attachment) -> Result<(), AttachmentRefused> {
        Ok(())
    }

    /// Whether examples bend the surface by their weights, 0 being rest. Otherwise they only add to the handles'
    /// effect, and a weight multiplies its example's addition.
    fn examples_bend(&self) -> bool {
        true
    }

    /// The triangles of its operator.
    fn triangulation<'a>(&self, problem: &Problem<'a>) -> Triangulation<'a> {
        Triangulation::of_surface(problem.surface, problem.topology)
    }

    /// The way in which hard handles hold their vertices.
    fn handle_fit(&self) -> HandleFit {
        HandleFit::Exact
    }

    /// Whether [`crate::Constraints::continuity`] has an effect.
    fn has_continuity(&self) -> bool {
        false
    }

    /// The option, at its present value, that is in sizes of the bending part ([`crate::Problem`]), and the power of
    /// the size in it.
    fn counts_in_sizes(&self) -> Option<(&'static str, i32)> {
        None
    }

    /// The largest turns of a limb that it does not narrow; `None` if it follows half a turn, or has its own sentence.
    fn follows_turns(&self) -> Option<Followed> {
        None
    }

    /// Whether it can be bound with an ordering of power 1 instead of its own, by the Laplacian's factor, which takes
    /// less memory and more time.
    fn takes_first_power(&self) -> bool {
        false
    }

    /// Whether each vertex of a handle can have its own place, by an offset from the handle's motion ([`Offsets`]).
    fn takes_places(&self) -> bool {
        false
    }

    /// Bytes of a solved vertex in the method's tables, without matrices and factors, whose entries are counted one by
    /// one: as allocated, measured by `tests/memory.rs`.
    fn row_bytes(&self) -> usize {
        300
    }

    /// Bytes of each handle at a solved vertex during binding: twice four numbers in single precision.
    fn handle_row_bytes(&self) -> usize {
        32
    }

    /// Computes everything that does not depend on the handles' transforms.
    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError>;
}

/// The input of a method's binding. The problem is checked already.
#[derive(Clone, Copy)]
pub(crate) struct BindInput<'a> {
    pub problem: &'a Problem<'a>,
    /// The partition into solved and prescribed vertices.
    pub partition: &'a Partition<'a>,
    pub handles: &'a [Handle],
    /// The attachments that were brought, checked by [`DeformMethod::check_attachment`].
    pub attachment: Option<&'a Attachment>,
    /// The ordering that [`Needs`] requires.
    pub ordering: Option<&'a Ordering>,
    /// The parts of the factor that are kept or reused, if possible.
    pub refactorisation: Refactorisation<'a>,
    pub progress: &'a Progress,
    pub cancel: &'a Cancel,
}

impl<'a> BindInput<'a> {
    /// The ordering of the method's power.
    ///
    /// # Errors
    /// There is none, or it is for another mesh or power.
    pub fn ordering(&self) -> Result<&'a Ordering, BindError> {
        self.ordering_of(self.problem.method.needs().ordering_power().unwrap_or(1))
    }

    /// The ordering, which must be of this power.
    ///
    /// # Errors
    /// Those of [`BindInput::ordering`].
    pub fn ordering_of(&self, expected_power: u32) -> Result<&'a Ordering, BindError> {
        let ordering = self.ordering.ok_or(BindError::NoOrdering { expected_power })?;
        let expected = self.problem.surface.positions.len();
        let (found, found_power) = (ordering.vertex_count(), ordering.power());
        if (found, found_power) == (expected, expected_power) {
            Ok(ordering)
        } else {
            Err(BindError::Ordering {
                found,
                found_power,
                expected,
                expected_power,
            })
        }
    }
}

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

    /// Sets the flag that ends a step which only settles a shape: once it is raised, the step returns with the shape that
    /// it has reached.
    fn set_cancel(&mut self, _cancel: &Cancel) {}

    /// Called when all handles are back at rest: the next step begins at rest.
    fn rest(&mut self) {}

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

    /// The factor, if the next binding can reuse parts of it.
    fn reusable_factor(&self) -> Option<ReusableFactor> {
        None
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
    /// [takes places](DeformMethod::takes_places). The next step has new targets then.
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
        0
    }

    /// The approximate cost of a step, in vertices of a method with cheap steps.
    fn step_cost(&self) -> usize {
        self.solved_count()
    }

    /// Sentences about repairs.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// Sentences about motions that the method can't follow.
    fn blind_to(&self, _motions: &[Motion]) -> Vec<Warning> {
        Vec::new()
    }
}

/// The way in which hard handles hold their vertices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum HandleFit {
    /// Exactly at the targets of the handle's transform.
    Exact,
    /// As near to the targets as the method can.
    LeastSquares,
}

/// The result of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stepped {
    /// Whether further steps to the same motions would change nothing, and the shape is a minimum.
    pub converged: bool,
    /// Whether further steps would change nothing although the shape is no minimum: no step was found that lowers the
    /// energy.
    pub stalled: bool,
    /// See [`crate::Step::energy`].
    pub energy: f64,
    /// Whether all displacements are finite, if that was checked while they were computed.
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

/// Sets whether a shape was found to be finite during its computation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Finite {
    Yes,
    Unknown,
}
