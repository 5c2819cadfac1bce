//! The start for new targets: the rest pose or the last one, moved by the handles' blended motions.

use glam::{DMat3, DQuat, DVec3};
use rayon::prelude::*;

use super::bodies::Bodies;
use crate::handles::Motion;
use crate::handles::blend::{Origin, Screws};
use crate::handles::screw::{Screw, carried};
use crate::numerical::rows::CHUNK;

impl Bodies {
    /// Makes the better of two starts the current pose for `motions`.
    pub(super) fn start(&mut self, motions: &[Motion]) {
        let was_at_rest = self.motions.iter().all(Motion::is_rest);
        let Screws { from_rest, onwards, .. } = Screws::of(&self.handles, &self.motions, motions);
        self.motions.copy_from_slice(motions);
        if !was_at_rest {
            self.carry(&onwards, Origin::Current);
            std::mem::swap(&mut self.current, &mut self.trial);
        }
        self.carry(&from_rest, Origin::Rest);
        if was_at_rest || self.trial.energy < self.current.energy || !self.current.energy.is_finite() {
            self.memory.clear();
            std::mem::swap(&mut self.current, &mut self.trial);
        }
        self.age = 0;
        self.state = self.how_folded();
    }

    /// Begins a descent to the present targets from the rest pose.
    pub(super) fn start_from_rest(&mut self) {
        let Screws { from_rest, .. } = Screws::of(&self.handles, &self.motions, &self.motions);
        self.carry(&from_rest, Origin::Rest);
        self.memory.clear();
        std::mem::swap(&mut self.current, &mut self.trial);
        self.age = 0;
        self.state = self.how_folded();
    }

    /// Makes the trial pose the rest pose or the current one, moved by `screws`, with the grounds at their targets.
    fn carry(&mut self, screws: &[Screw], origin: Origin) {
        let Self {
            current,
            trial,
            weights,
            joints,
            ..
        } = self;
        let (count, handle_count) = (joints.count(), screws.len());
        trial
            .rotations
            .par_iter_mut()
            .zip(&mut trial.turns[..count])
            .zip(&mut trial.shifts[..count])
            .with_min_len(CHUNK)
            .enumerate()
            .for_each(|(prism, ((rotation, turn), shift))| {
                let (before, turned) = match origin {
                    Origin::Rest => (DVec3::ZERO, DQuat::IDENTITY),
                    Origin::Current => (current.shifts[prism], current.rotations[prism]),
                };
                let own = &weights[prism * handle_count..(prism + 1) * handle_count];
                let carried = carried(joints.centres[prism] + before, screws, own);
                *rotation = (carried.turn * turned).normalize();
                *turn = DMat3::from_quat(*rotation);
                *shift = before + carried.displacement;
            });
        trial.turns[count] = DMat3::IDENTITY;
        trial.shifts[count] = DVec3::ZERO;
        for (ground, (handle, motion)) in self.handles.iter().zip(&self.motions).enumerate() {
            self.trial.turns[count + 1 + ground] = handle.linear(motion);
            self.trial.shifts[count + 1 + ground] = motion.shift;
        }
        self.trial.settle(&self.joints, &self.springs);
        self.trial.evaluate(&self.joints);
    }
}
