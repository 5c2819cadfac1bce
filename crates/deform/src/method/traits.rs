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
    /// What an option is set to; `None` if there is none of this name.
    fn value(&self, option: &str) -> Option<OptionValue>;

    /// Sets an option, whatever its range; `None` if there is none of this name and kind.
    fn set(&mut self, option: &str, value: OptionValue) -> Option<()>;

    /// A copy.
    fn boxed_clone(&self) -> Box<dyn DeformMethod>;

    /// Whether `other` is the same method with the same options.
    fn equals(&self, other: &dyn DeformMethod) -> bool;
}

/// A method: its options, and how to bind them.
pub(crate) trait DeformMethod: Options {
    /// What it says of itself.
    fn declaration(&self) -> &'static MethodDeclaration;

    /// What it works on.
    fn needs(&self) -> Needs;

    /// How it is solved once it is bound.
    fn solve(&self) -> Solve;

    /// Refuses options that exclude each other. The range of each option was checked before.
    fn check(&self) -> Result<(), OptionRefused> {
        Ok(())
    }

    /// Where the control points of a lattice rest, for a method that takes one.
    fn lattice_points(&self, _lattice: &ControlLattice) -> Vec<DVec3> {
        Vec::new()
    }

    /// Refuses an attachment of a declared kind that can't be bound with these options, whatever the surface. Its table
    /// `moved` and what is not finite are checked afterwards.
    fn check_attachment(&self, _attachment: &Attachment) -> Result<(), AttachmentRefused> {
        Ok(())
    }

    /// Whether examples bend the surface by their weights, 0 being rest. Otherwise they only add to what handles do, and
    /// a weight multiplies what its example adds.
    fn examples_bend(&self) -> bool {
        true
    }

    /// The triangles that its operator is made on.
    fn triangulation<'a>(&self, problem: &Problem<'a>) -> Triangulation<'a> {
        Triangulation::of_surface(problem.surface, problem.topology)
    }

    /// How hard handles hold their vertices.
    fn handle_fit(&self) -> HandleFit {
        HandleFit::Exact
    }

    /// Whether [`crate::Constraints::continuity`] changes what it does.
    fn has_continuity(&self) -> bool {
        false
    }

    /// The option that counts in sizes of what bends ([`crate::Problem`]) as it is set, and the power of the size in it.
    fn counts_in_sizes(&self) -> Option<(&'static str, i32)> {
        None
    }

    /// The turns that it bends a limb by without narrowing it; `None` where it follows half a turn, or has a sentence of
    /// its own.
    fn follows_turns(&self) -> Option<Followed> {
        None
    }

    /// Whether it can be bound with an ordering of power 1 in place of its own, by the Laplacian's factor, which takes
    /// less memory and more time.
    fn takes_first_power(&self) -> bool {
        false
    }

    /// Whether each vertex of a handle can have a place of its own, beside the handle's motion ([`Offsets`]).
    fn takes_places(&self) -> bool {
        false
    }

    /// Bytes of a solved vertex in the method's tables, without matrices and factors, whose entries are counted one by
    /// one: as allocated, measured by `tests/memory.rs`.
    fn row_bytes(&self) -> usize {
        300
    }

    /// Bytes that each handle takes at a solved vertex while it is bound: twice four numbers in single precision.
    fn handle_row_bytes(&self) -> usize {
        32
    }

    /// Computes what does not depend on the handles' transforms.
    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError>;
}

/// What a method is bound from. The problem is checked already.
#[derive(Clone, Copy)]
pub(crate) struct BindInput<'a> {
    pub problem: &'a Problem<'a>,
    /// Who is solved for, who is prescribed.
    pub partition: &'a Partition<'a>,
    pub handles: &'a [Handle],
    /// What was brought of what the method takes, checked by [`DeformMethod::check_attachment`].
    pub attachment: Option<&'a Attachment>,
    /// The one that [`Needs`] asks for.
    pub ordering: Option<&'a Ordering>,
    /// What of the factor is kept or taken over, where there is one that can be.
    pub refactorisation: Refactorisation<'a>,
    pub progress: &'a Progress,
    pub cancel: &'a Cancel,
}

impl<'a> BindInput<'a> {
    /// The ordering of the method's power.
    ///
    /// # Errors
    /// There is none, or it is another mesh's or power's.
    pub fn ordering(&self) -> Result<&'a Ordering, BindError> {
        self.ordering_of(self.problem.method.needs().ordering_power().unwrap_or(1))
    }

    /// The ordering, which must be of this power.
    ///
    /// # Errors
    /// As [`BindInput::ordering`].
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
/// `motions` has one entry per handle, `displacements` one per surface vertex. At least one handle moves, the hand
/// has moved a control point, or the weight of an example is set and not 0.
pub(crate) trait BoundMethod: Debug + Send + Sync {
    /// One step: fills *all* of `displacements`, handles' vertices and zeros included.
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError>;

    /// As `step`, but solves where a step takes a short cut.
    fn step_by_back_substitution(
        &mut self,
        motions: &[Motion],
        displacements: &mut [DVec3],
    ) -> Result<Stepped, SolveError> {
        self.step(motions, displacements)
    }

    /// No handle moves any more: the next step begins at rest.
    fn rest(&mut self) {}

    /// The energy of any displacements, if the energy is a function of the vertices.
    fn energy_of(&self, _motions: &[Motion], _displacements: &[DVec3]) -> Option<f64> {
        None
    }

    /// Fills in a handle's weight at each surface vertex, from 0 to 1, where the method spreads what the handle does by
    /// weights; `weights` are zeros. Whether it does.
    fn weights_of(&self, _handle: usize, _weights: &mut [f64]) -> bool {
        false
    }

    /// Replaces the surface's displacements by those that take its vertices to the smooth base, bent as the last step has
    /// bent it, where the method bends one and puts the details back on it. Whether it does. Only linear methods may.
    fn base(&self, _displacements: &mut [DVec3]) -> bool {
        false
    }

    /// Fills in the Jacobian of the displacements at each surface vertex, as of the last step, where the method knows
    /// its map's derivative: normals are then turned by the inverse transpose of I plus it. Whether it does.
    fn jacobians(&self, _motions: &[Motion], _out: &mut [Mat3]) -> bool {
        false
    }

    /// The handles' bases, where a step is a product with them.
    fn handle_bases(&self) -> Option<&HandleBases> {
        None
    }

    /// The factor, where the next binding can take over parts of it.
    fn reusable_factor(&self) -> Option<ReusableFactor> {
        None
    }

    /// Its control points, where it has some.
    fn controls(&self) -> Option<&Controls> {
        None
    }

    /// The same, to be moved by hand.
    fn controls_mut(&mut self) -> Option<&mut Controls> {
        None
    }

    /// Where its control points are while the handles have these motions.
    fn control_positions(&self, motions: &[Motion]) -> Vec<DVec3> {
        self.controls()
            .map(|controls| controls.positions(motions))
            .unwrap_or_default()
    }

    /// Sets by how much vertices of handles go elsewhere than their handles' motions take them, for a method that
    /// [takes places](DeformMethod::takes_places). The next step is one to new targets.
    fn set_offsets(&mut self, _offsets: &Arc<Offsets>) {}

    /// Sets the weights of the examples that were brought, `None` where one is to be found.
    fn set_weights(&mut self, _weights: &[Option<f64>]) {}

    /// The weights of these examples as of the last step.
    fn weights(&self) -> &[f64] {
        &[]
    }

    /// How many vertices are solved for.
    fn solved_count(&self) -> usize;

    /// How many numbers its factors store, 8 bytes each.
    fn factor_len(&self) -> usize {
        0
    }

    /// About what a step costs, in vertices of a method whose steps are cheap.
    fn step_cost(&self) -> usize {
        self.solved_count()
    }

    /// Sentences about what had to be repaired.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// Sentences about what these motions ask for and the method can't follow.
    fn blind_to(&self, _motions: &[Motion]) -> Vec<Warning> {
        Vec::new()
    }
}

/// How hard handles hold their vertices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum HandleFit {
    /// They go exactly where the handle's transform takes them.
    Exact,
    /// The method brings them there as well as it can.
    LeastSquares,
}

/// What a step did.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stepped {
    /// Whether further steps to the same motions would change nothing, and the shape is a minimum.
    pub converged: bool,
    /// Whether further steps would change nothing although the shape is none: no step was found that lowers the energy.
    pub stalled: bool,
    /// As in [`crate::Step::energy`].
    pub energy: f64,
    /// Whether all displacements are finite, if that was checked while they were computed.
    pub finite: Finite,
}

impl Stepped {
    /// The one step of a method that solves at once, after which further steps to the same motions change nothing.
    pub(crate) fn at_once(energy: f64, finite: Finite) -> Self {
        Self {
            converged: true,
            stalled: false,
            energy,
            finite,
        }
    }
}

/// Whether a shape was found to be finite while it was computed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Finite {
    Yes,
    Unknown,
}
