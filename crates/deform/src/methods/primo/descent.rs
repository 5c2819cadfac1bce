//! The bodies' energy as it descends.

use rayon::prelude::*;

use super::bodies::{Bodies, State};
use super::hierarchy::Preconditioner;
use crate::descent::energy::{Energy, lower};
use crate::descent::rule::Rule;
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::{Field, dot};

/// Steps towards the same targets after which the matrix is factored again at the current pose. A factorisation takes
/// about as long as eight steps. On the bar of [BS08] at a thickness of 0.005, factoring at every step (plain
/// Gauss–Newton) came within 1% of the least energy after 5 steps, at every tenth step after 25, and only at rest after
/// 133, in 1.9, 1.5 and 6.2 s; at 0.05 after 1, 1 and 2 steps.
const RENEWAL: u32 = 20;

/// Energies below this share of the surface's area are rounding.
const NOTHING: f64 = 1e-26;

/// A decrease by less than this share of the energy may be rounding.
const ROUNDED: f64 = 1e-10;

impl Bodies {
    /// Takes one step that lowers the energy, or finds that there is none.
    pub(super) fn descend(&mut self) {
        if self.age == RENEWAL {
            self.age = 0;
            if let Preconditioner::Direct(factored) = &mut self.preconditioner {
                factored.renew(&self.joints, &self.current);
                self.is_renewed = true;
            }
        }
        self.age += 1;
        let rule = Rule {
            tolerance: self.tolerance,
            nothing: NOTHING * self.joints.area,
            rounded: ROUNDED,
        };
        let lowered = lower(self);
        self.state = State::Steps(rule.state(lowered, self.current.energy));
    }
}

impl Energy for Bodies {
    fn value(&self) -> f64 {
        self.current.energy
    }

    fn aim(&mut self) -> f64 {
        let (preconditioner, joints) = (&self.preconditioner, &self.joints);
        self.uphill = self
            .memory
            .direction(&self.current.gradient, |x| preconditioner.apply(joints, x));
        -dot(&self.uphill, &self.current.gradient)
    }

    fn try_length(&mut self, length: f64) -> f64 {
        self.trial.moved(&self.current, &self.uphill, -length);
        self.trial.settle(&self.joints, &self.springs);
        self.trial.evaluate(&self.joints);
        self.trial.energy
    }

    fn accept(&mut self, length: f64) {
        let difference = |k: usize| {
            let (new, old) = (self.trial.gradient[k], self.current.gradient[k]);
            [new[0] - old[0], new[1] - old[1], new[2] - old[2]]
        };
        let change: Field = (0..self.uphill.len())
            .into_par_iter()
            .with_min_len(4 * CHUNK)
            .map(difference)
            .collect();
        let step = self
            .uphill
            .par_iter()
            .with_min_len(4 * CHUNK)
            .map(|value| value.map(|v| v * -length))
            .collect();
        self.memory.push(step, change);
        std::mem::swap(&mut self.current, &mut self.trial);
    }

    fn forget(&mut self) -> bool {
        let has_steps = !self.memory.is_empty();
        self.memory.clear();
        has_steps
    }
}
