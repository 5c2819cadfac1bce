//! Steps of a large surface's solver that are led by its coarse level.
//!
//! For new targets the coarse level steps first and its rotations are prolongated, in less time than the fine level's
//! own start and step take. For unchanged targets, corrections by the coarse level alternate with the fine level's
//! steps as long as they gain enough. An accepted correction is a step like any other: the energy falls, and the
//! history learns how soft the surface is along it, which the clusters, too stiff against bending, don't show.

use rayon::prelude::*;

use super::coarse::Coarse;
use super::descent::End;
use super::shape::{Guesses, IDENTITY};
use super::{ArapSolver, State};
use crate::handles::Motion;
use crate::handles::blend::{Origin, Screws};
use crate::numerical::rows::CHUNK;

/// Coarse steps for new targets: along a drag of 60 frames more than 4 did not get closer to the minimum, and 2 fell
/// behind.
const STEPS: u32 = 3;

/// Coarse steps of a correction.
const CORRECTING_STEPS: u32 = 10;

/// The most fine steps between two corrections.
const RAREST: u32 = 64;

/// The schedule of corrections.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corrections {
    /// Fine steps from one correction to the next.
    every: u32,
    /// Fine steps before the next one.
    left: u32,
    /// The decrease by the last fine step.
    gained: f64,
}

impl Default for Corrections {
    fn default() -> Self {
        Self {
            every: 1,
            left: 1,
            gained: f64::INFINITY,
        }
    }
}

impl ArapSolver {
    /// A step towards `motions`, led by `coarse`.
    pub(super) fn step_led(&mut self, coarse: &mut Coarse, motions: &[Motion]) {
        if self.takes_other(motions) {
            self.start_led(coarse, motions);
        } else if self.state == State::Descending && self.corrections.left == 0 {
            self.correct(coarse);
        } else if self.state == State::Descending {
            let before = self.current.energy;
            self.descend();
            self.corrections.gained = before - self.current.energy;
            self.corrections.left -= 1;
        }
    }

    /// Makes the shape for new motions that the coarse level predicts.
    ///
    /// From the rest shape only the blend is used: it is exact if everything moves rigidly, and the coarse level
    /// corrects it next.
    fn start_led(&mut self, coarse: &mut Coarse, motions: &[Motion]) {
        self.corrections = Corrections::default();
        if self.motions.iter().all(Motion::is_rest) {
            coarse.aim();
            self.start(motions);
            self.corrections.left = 0;
            return;
        }
        self.finish_step();
        coarse.restrict(&self.current, self.unit, &self.motions);
        let Screws { from_rest, onwards } = Screws::of(&self.handles, &self.motions, motions);
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
    fn correct(&mut self, coarse: &mut Coarse) {
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
        let is_worth_it = gained > 2.0 * self.corrections.gained;
        let every = if is_worth_it { 1 } else { 2 * self.corrections.every };
        self.corrections.every = every.min(RAREST);
        self.corrections.left = self.corrections.every;
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
        springs.add_energy(trial);
    }

    /// Takes the trial shape to the minimum of the energy for its present rotations: one global step.
    pub(super) fn relax_trial(&mut self) {
        let Self {
            trial,
            scratch,
            cells,
            springs,
            ..
        } = self;
        cells.find_pull(trial, scratch);
        springs.add_gradient(trial);
        let unit = self.unit;
        self.direction.resize(trial.gradient.len(), Default::default());
        self.preconditioner
            .map(&trial.gradient, &mut self.direction, &mut self.map_room);
        trial.displacements[..trial.gradient.len()]
            .par_chunks_mut(CHUNK)
            .zip(self.direction.par_chunks(CHUNK))
            .for_each(|(own, step)| {
                for (own, step) in own.iter_mut().zip(step) {
                    for k in 0..3 {
                        own[k] -= f64::from(step[k]) * unit;
                    }
                }
            });
    }

    /// Ends the present descent and begins one for `motions`, with the present shape.
    pub(super) fn leave(&mut self, motions: &[Motion]) {
        self.motions.copy_from_slice(motions);
        self.springs.aim(motions);
        self.history.drop_pending();
        self.end = End::Known;
    }
}
