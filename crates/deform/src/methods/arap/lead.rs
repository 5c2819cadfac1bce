//! Steps of a large surface's solver that are led by its coarse level.
//!
//! For new targets the coarse level steps first and its rotations are prolongated, in less time than the fine level's
//! own start and step take. For unchanged targets, corrections by the coarse level alternate with the fine level's
//! steps as long as they gain enough. An accepted correction is a step like any other: the energy falls, and the
//! history learns how soft the surface is along it, which the clusters, too stiff against bending, don't show.

use glam::DVec3;
use pliant_mesh::{Cancel, Progress};
use rayon::prelude::*;

use super::coarse::Coarse;
use super::end::End;
use super::shape::{Guesses, IDENTITY, Shape};
use super::{Arap, ArapSolver};
use crate::descent::corrections::Corrections;
use crate::descent::rival::{Rival, aim, compare};
use crate::descent::rule::State;
use crate::handles::blend::{Origin, Screws};
use crate::handles::offsets::Offsets;
use crate::handles::{Handle, Motion};
use crate::numerical::rows::CHUNK;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;
use crate::{BindError, Ordering};

/// Coarse steps for new targets: along a drag of 60 frames more than 4 did not get closer to the minimum, and 2 fell
/// behind.
const STEPS: u32 = 3;

/// Coarse steps of a correction.
const CORRECTING_STEPS: u32 = 10;

/// The most fine steps between two corrections.
const RAREST: u32 = 64;

/// The bound method: a solver and, for a large surface, the coarse level that leads it.
#[derive(Debug)]
pub(crate) struct LedSolver {
    pub(super) solver: ArapSolver,
    coarse: Option<Coarse>,
    corrections: Corrections,
    pub(super) rival: Rival<First>,
}

/// The end of a drag's own descent, while a second one is tried.
#[derive(Debug)]
pub(crate) struct First {
    pub shape: Shape,
    pub state: State,
}

impl LedSolver {
    /// Binds the solver and, if the surface is large, its coarse level.
    pub fn bind(
        problem: &BoundaryProblem,
        options: &Arap,
        partition: &Partition,
        handles: &[Handle],
        ordering: &Ordering,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        let solver = ArapSolver::bind(problem, options, partition, handles, ordering, progress, cancel)?;
        let coarse = (solver.domain.solved_count > options.coarse_above)
            .then(|| Coarse::of(problem, options, handles, &solver.domain, cancel))
            .flatten();
        cancel.check()?;
        Ok(Self {
            solver,
            coarse,
            corrections: Corrections::after(1, RAREST),
            rival: Rival::default(),
        })
    }

    /// One step towards `motions`: writes the solved vertices' displacements. Returns whether the shape converged, and
    /// the energy.
    pub fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> (bool, f64) {
        if self.solver.has_other_offsets || self.solver.motions != motions {
            aim(self, motions);
        }
        let Self {
            solver,
            coarse,
            corrections,
            ..
        } = self;
        match coarse {
            None => solver.step(motions),
            // The pool is entered once: see the solver's own step.
            Some(coarse) => rayon::scope(|_| solver.step_led(coarse, corrections, motions)),
        }
        compare(self);
        let energy = self.solver.read(self.shown(), displacements);
        if !energy.is_finite() {
            // The gate refuses it; the next targets begin afresh.
            self.rest();
            return (true, energy);
        }
        (self.solver.state == State::Converged, energy)
    }

    /// Begins the descent to `motions` at a shape, if that is lower than the blend from rest.
    pub fn begin_at(&mut self, motions: &[Motion], displacements: &[DVec3]) {
        self.rival.end();
        if let Some(coarse) = &mut self.coarse {
            coarse.aim();
        }
        self.hurry_corrections();
        rayon::scope(|_| self.solver.start_at(motions, displacements));
    }

    /// The next step of a new descent is a correction.
    pub(super) fn hurry_corrections(&mut self) {
        self.corrections = Corrections::after(1, RAREST);
        self.corrections.hurry();
    }

    /// Sets the offsets of handles' vertices from their handles' motions.
    pub fn set_offsets(&mut self, offsets: &Offsets) {
        self.solver.set_offsets(offsets);
        if let Some(coarse) = &mut self.coarse {
            coarse.set_offsets(offsets);
        }
    }

    /// Returns to the rest shape.
    pub fn rest(&mut self) {
        self.rival.end();
        self.solver.rest();
        if let Some(coarse) = &mut self.coarse {
            coarse.rest();
        }
    }

    /// The number of entries that the factors store.
    pub fn factor_len(&self) -> usize {
        self.solver.factor_len() + self.coarse.as_ref().map_or(0, Coarse::factor_len)
    }
}

impl ArapSolver {
    /// A step towards `motions`, led by `coarse`.
    fn step_led(&mut self, coarse: &mut Coarse, corrections: &mut Corrections, motions: &[Motion]) {
        if self.takes_other(motions) {
            self.start_led(coarse, corrections, motions);
        } else if self.state == State::Descending && corrections.is_due() {
            self.correct(coarse, corrections);
        } else if self.state == State::Descending {
            let before = self.current.energy;
            self.descend();
            corrections.stepped(before - self.current.energy);
        }
    }

    /// Makes the shape for new motions that the coarse level predicts.
    ///
    /// From the rest shape only the blend is used: it is exact if everything moves rigidly, and the coarse level
    /// corrects it next.
    fn start_led(&mut self, coarse: &mut Coarse, corrections: &mut Corrections, motions: &[Motion]) {
        *corrections = Corrections::after(1, RAREST);
        if self.motions.iter().all(Motion::is_rest) {
            coarse.aim();
            self.start(motions);
            corrections.hurry();
            return;
        }
        self.finish_step();
        coarse.restrict(&self.current, self.unit, &self.motions);
        let Screws { from_rest, onwards, .. } = Screws::of(&self.handles, &self.motions, motions);
        coarse.aim();
        let screws = match coarse.start(motions, STEPS) {
            Origin::Current => onwards,
            Origin::Rest => {
                self.history.clear();
                self.current.displacements.fill([0.0; 4]);
                self.current.rotations.fill(IDENTITY);
                from_rest
            }
        };
        self.leave(motions);
        if coarse.leads_all() {
            self.trial.displacements.copy_from_slice(&self.current.displacements);
            self.trial.place(&self.prescribed, motions);
        } else {
            self.carry_unmeasured(&screws, Origin::Current);
        }
        self.prolongate(coarse);
        std::mem::swap(&mut self.current, &mut self.trial);
        self.end = End::Unknown;
        self.state = State::Descending;
    }

    /// Accepts the coarse level's correction if it lowers the energy.
    fn correct(&mut self, coarse: &mut Coarse, corrections: &mut Corrections) {
        self.finish_step();
        // The history adds the step before, and has the mapped gradient at the beginning of this one.
        self.map_gradient();
        self.history.factors(&self.trial.gradient, &self.current.gradient);
        coarse.restrict(&self.current, self.unit, &self.motions);
        coarse.go_on(CORRECTING_STEPS);
        self.trial.displacements.copy_from_slice(&self.current.displacements);
        self.trial.rotations.copy_from_slice(&self.current.rotations);
        self.prolongate(coarse);
        let gained = self.current.energy - self.trial.energy;
        corrections.corrected(gained, 2.0);
        if gained > 0.0 {
            let factor = self.unit.recip();
            self.direction
                .par_chunks_mut(CHUNK)
                .zip(self.current.displacements.par_chunks(CHUNK))
                .zip(self.trial.displacements.par_chunks(CHUNK))
                .for_each(|((direction, old), new)| {
                    for ((direction, old), new) in direction.iter_mut().zip(old).zip(new) {
                        for k in 0..3 {
                            direction[k] = ((old[k] - new[k]) * factor) as f32;
                        }
                    }
                });
            std::mem::swap(&mut self.current, &mut self.trial);
            self.end = End::Stepped(1.0);
        }
    }

    /// Prolongates the coarse level's rotations since the current shape to the trial shape's cells, and takes one
    /// global step to the minimum of the energy with these rotations.
    fn prolongate(&mut self, coarse: &mut Coarse) {
        coarse.turn(&self.current.rotations, &mut self.trial.rotations);
        self.relax_trial();
        let Self {
            trial,
            scratch,
            cells,
            springs,
            ..
        } = self;
        cells.measure(trial, Guesses::Own, scratch);
        trial.add_energy_of(springs);
    }
}
