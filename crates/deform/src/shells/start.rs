//! The start for new targets: the rest shape or the last one, moved by the handles' blended motions.

use glam::DVec3;
use rayon::prelude::*;

use super::elements::ABSENT;
use super::{Descent, ShellsSolver};
use crate::handles::Motion;
use crate::handles::blend::{Origin, Screw, Screws, carried};
use crate::operators::CHUNK;

impl ShellsSolver {
    /// Makes the best start the current shape for `motions`, and returns which one it was: the rest shape carried, the
    /// last one carried, or the last one as it was.
    ///
    /// Loads belong to the shape that they were computed at: a start from rest has none, and the starts are compared
    /// without them.
    pub(super) fn start(&mut self, motions: &[Motion]) -> Origin {
        let was_at_rest = self.motions.iter().all(Motion::is_rest);
        let Screws { from_rest, onwards } = Screws::of(&self.handles, &self.motions, motions);
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
        for (screws, origin) in &starts[..if was_at_rest { 1 } else { 3 }] {
            self.carry(screws, *origin);
            self.energy.evaluate(&mut self.trial, &self.energy.springs);
            if self.trial.energy < best.0.energy {
                std::mem::swap(&mut best.0, &mut self.trial);
                best.1 = *origin;
            }
        }
        if !best.0.energy.is_finite() {
            // It is refused.
            std::mem::swap(&mut best.0, &mut self.trial);
        }
        self.current = best.0;
        if best.1 == Origin::Rest {
            self.memory.clear();
        } else {
            self.energy.springs.loads = loads;
            self.current.energy += self.energy.springs.load_energy(&self.current.displacements);
        }
        best.1
    }

    /// Makes the trial shape the rest shape or the current one, carried by `screws`, with the handles where they go.
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
        for (own, motion) in self.prescribed.iter().zip(&self.motions) {
            for vertex in own.iter().filter(|vertex| vertex.local != ABSENT) {
                trial.displacements[vertex.local as usize] = motion.displace(vertex.coordinates);
            }
        }
    }
}
