//! The start for new targets: the rest shape or the last one, moved by the handles' blended motions, or the blended
//! examples, carried by these motions.

use glam::{DMat3, DQuat, DVec3};
use rayon::prelude::*;

use super::carry::{Base, Strains};
use super::elements::ABSENT;
use super::shape::Energy;
use super::{Blending, Descent, ShellsSolver};
use crate::descent::prescribed::Prescribed;
use crate::handles::Motion;
use crate::handles::blend::{Origin, Screws};
use crate::handles::screw::{Screw, carried};
use crate::numerical::rows::CHUNK;

/// The number of solutions for a blended shape with a factor in single precision; each corrects the last.
const ROUNDS: u32 = 2;

impl ShellsSolver {
    /// Makes the best start the current shape for `motions`, and returns its origin: the rest shape carried, the last
    /// one carried, or the last one unchanged.
    ///
    /// Loads belong to the shape that they were computed at: a start from rest has none, and the starts are compared
    /// without them.
    pub(super) fn start(&mut self, motions: &[Motion]) -> Origin {
        let was_at_rest = self.is_at_rest();
        let Screws {
            from_rest,
            onwards,
            may_stay,
        } = Screws::of(&self.handles, &self.motions, motions);
        self.motions.copy_from_slice(motions);
        self.energy.springs.aim(motions);
        let loads = std::mem::take(&mut self.energy.springs.loads);
        if let Some(Descent::Newton(system)) = &mut self.descent {
            system.undamp();
        }
        (self.has_converged, self.has_slopes) = (false, false);
        let starts = [
            (&from_rest[..], Origin::Rest),
            (&onwards[..], Origin::Current),
            (&[], Origin::Current),
        ];
        let mut best = (self.current.clone(), Origin::Rest);
        best.0.energy = f64::INFINITY;
        let count = match (was_at_rest, may_stay) {
            (true, _) => 1,
            (false, false) => 2,
            (false, true) => 3,
        };
        for (screws, origin) in &starts[..count] {
            self.carry(screws, *origin);
            self.energy.evaluate(&mut self.trial, &self.energy.springs);
            if self.trial.energy < best.0.energy {
                std::mem::swap(&mut best.0, &mut self.trial);
                best.1 = *origin;
            }
        }
        if self.blend(&from_rest) {
            self.energy.evaluate(&mut self.trial, &self.energy.springs);
            if self.trial.energy < best.0.energy {
                std::mem::swap(&mut best.0, &mut self.trial);
                best.1 = Origin::Rest;
            }
        }
        if !best.0.energy.is_finite() {
            // The caller refuses this shape.
            std::mem::swap(&mut best.0, &mut self.trial);
        }
        self.current = best.0;
        if best.1 == Origin::Rest {
            self.memory.clear();
        } else {
            self.energy.springs.loads = loads;
            self.current.energy += self
                .energy
                .springs
                .load_energy(|vertex| self.current.displacements[vertex]);
        }
        best.1
    }

    /// Makes the trial shape the blend of the examples with the given weights and a guess of the free ones, carried by
    /// `screws`. Returns true if there are examples to blend.
    fn blend(&mut self, screws: &[Screw]) -> bool {
        let Some(mut blending) = self.blending.take() else {
            return false;
        };
        let is_blended = self.blend_by(&mut blending, screws);
        self.blending = Some(blending);
        is_blended
    }

    fn blend_by(&mut self, blending: &mut Blending, screws: &[Screw]) -> bool {
        let Some(preconditioner) = &mut blending.preconditioner else {
            return false;
        };
        self.carry(screws, Origin::Rest);
        let weights = self.guess();
        if weights.iter().all(|weight| *weight == 0.0) {
            return false;
        }
        let turns = self.blended_turns(blending.turns.blended(&weights), screws);
        let base = Base {
            places: &self.energy.elements.rest,
            turns: &turns,
            strains: Some(Strains::of(&self.energy, &blending.turns, &weights)),
        };
        for _ in 0..ROUNDS {
            let mut away = blending.carrier.pull(&self.energy, &base, &self.trial);
            preconditioner.apply(&mut away);
            self.trial.move_by(&away, -1.0);
        }
        self.trial.weights = weights;
        self.energy.relax_angles(&mut self.trial);
        true
    }

    /// The turn of each local vertex: the examples' turn, and further, by its handles' weights, the handles' turns
    /// beyond those of the examples.
    fn blended_turns(&self, mut turns: Vec<DQuat>, screws: &[Screw]) -> Vec<DMat3> {
        let further = |(own, screw): (&Vec<Prescribed>, &Screw)| {
            let own = own.iter().filter(|vertex| vertex.local != ABSENT);
            let blended = own.map(|vertex| turns[vertex.local as usize]);
            // Both signs are the same rotation.
            let sum = blended.reduce(|sum, turn| sum + turn * 1_f64.copysign(sum.dot(turn)));
            let blended = sum.map_or(DQuat::IDENTITY, DQuat::normalize);
            (screw.turn() * blended.conjugate()).to_scaled_axis()
        };
        let further: Vec<DVec3> = self.prescribed.iter().zip(screws).map(further).collect();
        for (local, _, vector) in Prescribed::seen(&self.prescribed, &further) {
            turns[local] = DQuat::from_scaled_axis(*vector) * turns[local];
        }
        let count = further.len();
        let solved_count = self.energy.elements.solved_count;
        let turn = |(vertex, turn): (usize, &DQuat)| {
            if count == 0 || vertex >= solved_count {
                return DMat3::from_quat(*turn);
            }
            let own = self.weights[vertex * count..(vertex + 1) * count].iter();
            let vector: DVec3 = own.zip(&further).map(|(weight, vector)| *vector * *weight).sum();
            DMat3::from_quat(DQuat::from_scaled_axis(vector) * *turn)
        };
        turns.par_iter().enumerate().with_min_len(CHUNK).map(turn).collect()
    }

    /// The given weights, and a guess of the free ones, which brings the constrained vertices nearest to their
    /// positions in the trial shape.
    fn guess(&self) -> Vec<f64> {
        let Energy { elements, examples, .. } = &self.energy;
        let held = elements.solved_count..elements.vertices.len();
        let held = held.map(|local| (local, self.trial.displacements[local]));
        examples.guess(held.chain(self.energy.springs.wanted()))
    }

    /// Makes the trial shape the rest shape or the current one, carried by `screws`, with the handles at their targets.
    pub(super) fn carry(&mut self, screws: &[Screw], origin: Origin) {
        let Self {
            current,
            trial,
            weights,
            energy,
            ..
        } = self;
        match origin {
            Origin::Rest => energy.rest(trial),
            Origin::Current => trial.clone_from(current),
        }
        let (count, solved_count) = (screws.len(), energy.elements.solved_count);
        if count > 0 {
            let rest = &energy.elements.rest;
            trial.displacements[..solved_count]
                .par_chunks_mut(CHUNK)
                .enumerate()
                .for_each(|(chunk, displacements)| {
                    for (vertex, displacement) in (chunk * CHUNK..).zip(displacements) {
                        let own = &weights[vertex * count..(vertex + 1) * count];
                        let before = *displacement;
                        *displacement += carried(rest[vertex] + before, screws, own).displacement;
                    }
                });
        }
        trial.displacements[solved_count..].fill(DVec3::ZERO);
        for (local, vertex, motion) in Prescribed::seen(&self.prescribed, &self.motions) {
            trial.displacements[local] = vertex.goes(motion);
        }
    }
}
