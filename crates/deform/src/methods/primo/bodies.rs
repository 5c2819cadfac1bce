//! Rigid bodies that joints couple, and their descent to rest: prisms of a surface, or cells of space.

use glam::DVec3;
use pliant_mesh::Cancel;

use super::colours::Colours;
use super::hierarchy::{DIRECT, Preconditioner};
use super::joints::Joints;
use super::pose::Pose;
use super::springs::Springs;
use crate::budget::{Budget, bytes_of};
use crate::descent::rival::{Rival, aim, compare};
use crate::descent::rule;
use crate::handles::blend::HandleFrame;
use crate::handles::{Handle, Motion};
use crate::numerical::lbfgs::Memory;
use crate::numerical::sums::Field;
use crate::sparse::factor_error::FactorError;

/// The bodies, with their present pose.
#[derive(Debug)]
pub(crate) struct Bodies {
    pub joints: Joints,
    pub(super) colours: Colours,
    pub(super) springs: Springs,
    pub(super) preconditioner: Preconditioner,
    /// Handles' harmonic weights, one row per solved body.
    pub(super) weights: Vec<f64>,
    /// The handles in coordinates relative to the origin.
    pub(super) handles: Vec<HandleFrame>,
    pub current: Pose,
    pub(super) trial: Pose,
    pub(super) memory: Memory,
    /// The last direction uphill.
    pub(super) uphill: Field,
    /// The motions of the `current` pose.
    pub(super) motions: Vec<Motion>,
    pub(super) state: State,
    /// Steps towards the present targets since the matrix was last factored.
    pub(super) age: u32,
    /// True if the matrix was factored at another pose than the rest pose.
    pub(super) is_renewed: bool,
    /// The relative decrease of the energy below which iteration ends.
    pub(super) tolerance: f64,
    pub(super) rival: Rival<First>,
}

/// The end of a drag's own descent, while a second one is tried.
#[derive(Debug)]
pub(crate) struct First {
    pub pose: Pose,
    pub state: State,
}

/// The progress towards the present targets.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum State {
    /// Prisms are folded onto their neighbours: local sweeps come first.
    Folded(u32),
    /// Steps lower the energy.
    Steps(rule::State),
}

impl Bodies {
    /// Factors, and solves for the weights of `handles`; all coordinates are relative to `world_origin`. Nothing is
    /// fixed around the bodies that are `unheld`.
    ///
    /// # Errors
    /// Those of [`crate::sparse::cholesky::Factor::to_descend_by`]; a pivot is named by its body.
    pub fn of(
        joints: Joints,
        handles: &[Handle],
        world_origin: DVec3,
        unheld: impl Fn(usize) -> bool,
        tolerance: f64,
        budget: Budget,
        cancel: &Cancel,
    ) -> Result<Self, FactorError> {
        let springs = Springs::of(&joints, budget, cancel)?;
        let budget = budget.without(bytes_of(springs.stored(), size_of::<f64>()))?;
        let weights = springs.weights(&joints, handles.len(), unheld);
        let at_rest = Pose::at_rest(joints.count(), 1 + handles.len());
        let preconditioner = Preconditioner::of(&joints, DIRECT, budget, cancel)?;
        Ok(Self {
            colours: Colours::of(&joints),
            joints,
            springs,
            preconditioner,
            weights,
            handles: HandleFrame::of_all(handles, world_origin),
            current: at_rest.clone(),
            trial: at_rest,
            memory: Memory::default(),
            uphill: Field::new(),
            motions: vec![Motion::default(); handles.len()],
            state: State::Steps(rule::State::Converged),
            age: 0,
            is_renewed: false,
            tolerance,
            rival: Rival::default(),
        })
    }

    /// The number of entries that the factor stores.
    pub fn factor_len(&self) -> usize {
        self.preconditioner.stored()
    }

    /// The energy in units of the solved prisms' area, so that it does not depend on the model's scale.
    fn relative(&self, energy: f64) -> f64 {
        if self.joints.area > 0.0 {
            energy / self.joints.area
        } else {
            0.0
        }
    }

    /// Returns to the rest pose.
    pub fn rest(&mut self) {
        self.motions.fill(Motion::default());
        self.current = Pose::at_rest(self.joints.count(), 1 + self.handles.len());
        self.memory.clear();
        self.rival.end();
        self.state = State::Steps(rule::State::Converged);
        // The following steps must be the same as after binding.
        if std::mem::take(&mut self.is_renewed)
            && let Preconditioner::Direct(factored) = &mut self.preconditioner
        {
            factored.renew(&self.joints, &self.current);
        }
    }

    /// One step towards `motions`.
    pub fn advance(&mut self, motions: &[Motion]) {
        if self.motions != motions {
            aim(self, motions);
            self.start(motions);
        }
        match self.state {
            State::Folded(left) => self.unfold(left),
            State::Steps(rule::State::Descending) => self.descend(),
            State::Steps(_) => {}
        }
        compare(self);
    }

    /// The pose to show: the end of a drag's own descent until a second one has ended.
    pub fn shown(&self) -> &Pose {
        self.rival.first().map_or(&self.current, |first| &first.pose)
    }

    /// Returns true if no step lowers the energy although the pose has not converged.
    pub fn has_stalled(&self) -> bool {
        self.state == State::Steps(rule::State::Stalled)
    }

    /// Returns whether the last step converged, and its energy. If it is not finite the next targets begin afresh.
    pub fn outcome(&mut self) -> (bool, f64) {
        let energy = self.shown().energy;
        if !energy.is_finite() {
            self.rest();
            return (true, energy);
        }
        (
            self.state == State::Steps(rule::State::Converged),
            self.relative(energy),
        )
    }
}
