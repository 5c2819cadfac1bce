//! The start for new targets: the rest shape or the last one, moved by the handles' blended motions.

use glam::{DQuat, DVec3};
use rayon::prelude::*;

use super::ArapSolver;
use super::cells::{quad, vector};
use super::end::End;
use super::shape::{Guesses, IDENTITY, Shape, narrow, wide};
use crate::descent::prescribed::Prescribed;
use crate::descent::rule::State;
use crate::handles::Motion;
use crate::handles::blend::{Origin, Screws};
use crate::handles::screw::{Screw, carried};
use crate::numerical::rows::CHUNK;

/// The blend from the rest shape is skipped for at most this many targets: it costs as much as a step and rarely wins
/// along a drag, but a drag may turn back.
const PATIENCE: u32 = 8;

impl ArapSolver {
    /// Makes the better of two starts the current shape for `motions`, and returns which one it was.
    ///
    /// Loads belong to the shape that they were computed at: a start from rest has none, and the two starts are
    /// compared without them.
    pub(super) fn start(&mut self, motions: &[Motion]) -> Origin {
        let was_at_rest = self.motions.iter().all(Motion::is_rest);
        let Screws { from_rest, onwards, .. } = Screws::of(&self.handles, &self.motions, motions);
        self.leave(motions);
        self.state = State::Descending;
        if was_at_rest {
            self.start_from_rest();
            (self.until_blend, self.patience) = (0, 1);
            return Origin::Rest;
        }
        self.carry(&onwards, Origin::Current);
        std::mem::swap(&mut self.current, &mut self.trial);
        if self.until_blend > 0 {
            self.until_blend -= 1;
            return Origin::Current;
        }
        let onwards = self.current.energy
            - self
                .springs
                .load_energy(|vertex| vector(self.current.displacements[vertex]));
        let loads = std::mem::take(&mut self.springs.loads);
        self.carry(&from_rest, Origin::Rest);
        let origin = if self.trial.energy < onwards || !onwards.is_finite() {
            self.history.clear();
            std::mem::swap(&mut self.current, &mut self.trial);
            self.patience = 1;
            Origin::Rest
        } else {
            self.springs.loads = loads;
            self.patience = PATIENCE.min(2 * self.patience);
            Origin::Current
        };
        self.until_blend = self.patience - 1;
        origin
    }

    /// Begins a descent to the present targets from the rest shape.
    pub(super) fn start_from_rest(&mut self) {
        let motions = self.motions.clone();
        self.leave(&motions);
        self.history.clear();
        self.springs.loads.clear();
        let Screws { from_rest, .. } = Screws::of(&self.handles, &motions, &motions);
        self.carry(&from_rest, Origin::Rest);
        std::mem::swap(&mut self.current, &mut self.trial);
        self.state = State::Descending;
    }

    /// Begins a descent to `motions` at a shape, or at the blend from rest if that is lower.
    ///
    /// Only the rotations of the shape's cells are taken: they fit another frame of the same body, whose own details one
    /// global step then puts in their places.
    pub(super) fn start_at(&mut self, motions: &[Motion], displacements: &[DVec3]) {
        self.has_other_offsets = false;
        self.leave(motions);
        self.start_from_rest();
        (self.until_blend, self.patience) = (0, 1);
        let Self {
            trial, domain, cells, ..
        } = self;
        for (own, &vertex) in trial.displacements.iter_mut().zip(&domain.vertices) {
            *own = quad(displacements[vertex as usize], 0.0);
        }
        trial.place(&self.prescribed, motions);
        trial.rotations.fill(IDENTITY);
        cells.measure(trial, Guesses::Own, &mut self.scratch);
        self.relax_trial();
        self.evaluate_trial();
        if self.trial.energy < self.current.energy {
            std::mem::swap(&mut self.current, &mut self.trial);
        }
    }

    /// Makes the trial shape the rest shape or the current one, carried by `screws`, with the handles at their targets,
    /// and evaluates it.
    fn carry(&mut self, screws: &[Screw], origin: Origin) {
        self.carry_unmeasured(screws, origin);
        if self.has_offsets {
            self.relax_trial();
        }
        self.evaluate_trial();
    }

    /// The energy and the gradient of the trial shape.
    fn evaluate_trial(&mut self) {
        self.cells.evaluate(&mut self.trial, Guesses::Own, &mut self.scratch);
        self.trial.add_energy_of(&self.springs);
        self.trial.add_gradient_of(&self.springs);
    }

    /// Like [`ArapSolver::carry`], without an evaluation.
    pub(super) fn carry_unmeasured(&mut self, screws: &[Screw], origin: Origin) {
        let Self {
            current,
            trial,
            weights,
            rest,
            ..
        } = self;
        let cell_count = current.rotations.len();
        let count = screws.len();
        trial
            .rotations
            .par_chunks_mut(CHUNK)
            .zip(trial.displacements[..cell_count].par_chunks_mut(CHUNK))
            .enumerate()
            .for_each(|(chunk, (rotations, displacements))| {
                for (place, (rotation, displacement)) in rotations.iter_mut().zip(displacements).enumerate() {
                    let cell = chunk * CHUNK + place;
                    let (before, turned) = match origin {
                        Origin::Rest => (DVec3::ZERO, DQuat::IDENTITY),
                        Origin::Current => (vector(current.displacements[cell]), wide(current.rotations[cell])),
                    };
                    let carried = carried(rest[cell] + before, screws, &weights[cell * count..(cell + 1) * count]);
                    *displacement = quad(before + carried.displacement, 0.0);
                    *rotation = narrow((carried.turn * turned).normalize());
                }
            });
        self.trial.place(&self.prescribed, &self.motions);
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
        trial.add_gradient_of(springs);
        let unit = self.unit;
        self.direction.resize(trial.gradient.len(), Default::default());
        self.preconditioner.map(&trial.gradient, &mut self.direction);
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

impl Shape {
    /// Sets the constrained vertices to their exact positions.
    pub(super) fn place(&mut self, prescribed: &[Vec<Prescribed>], motions: &[Motion]) {
        self.displacements[self.gradient.len()..].fill([0.0; 4]);
        for (local, vertex, motion) in Prescribed::seen(prescribed, motions) {
            self.displacements[local] = quad(vertex.goes(motion), 0.0);
        }
    }
}
