//! One descent step with a line search.

use rayon::prelude::*;

use super::bodies::{Bodies, State};
use super::hierarchy::Preconditioner;
use crate::numerical::line_search::Trial;
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::{Field, dot};

/// Lengths that a line search tries.
const TRIALS: u32 = 12;

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
    ///
    /// A pose has converged if the quadratic model promises a decrease below the tolerance's share of the energy and
    /// the last step gained less than that too. If no length of the step lowers the energy, it has converged only if
    /// the model promises little.
    pub(super) fn descend(&mut self) {
        if self.age == RENEWAL {
            self.age = 0;
            if let Preconditioner::Direct(factored) = &mut self.preconditioner {
                factored.renew(&self.joints, &self.current);
                self.is_renewed = true;
            }
        }
        self.age += 1;
        loop {
            let (preconditioner, joints) = (&self.preconditioner, &self.joints);
            let uphill = self
                .memory
                .direction(&self.current.gradient, |x| preconditioner.apply(joints, x));
            let slope = -dot(&uphill, &self.current.gradient);
            let before = self.current.energy;
            if slope < 0.0 && self.search(&uphill, slope) {
                let (gained, enough) = (
                    before - self.current.energy,
                    self.tolerance * self.current.energy + NOTHING * self.joints.area,
                );
                if -0.5 * slope <= enough && gained <= enough {
                    self.state = State::Converged;
                }
                return;
            }
            if self.memory.is_empty() {
                let little = self.tolerance.max(ROUNDED) * before + NOTHING * self.joints.area;
                let is_little = -0.5 * slope <= little;
                self.state = if is_little { State::Converged } else { State::Stalled };
                return;
            }
            self.memory.clear();
        }
    }

    /// Moves against `uphill`, by its whole length if that lowers the energy enough. Returns whether any length did.
    fn search(&mut self, uphill: &Field, slope: f64) -> bool {
        let before = self.current.energy;
        let mut length = 1.0;
        for _ in 0..TRIALS {
            self.trial.moved(&self.current, uphill, -length);
            self.trial.settle(&self.joints, &self.springs);
            self.trial.evaluate(&self.joints);
            let trial = Trial {
                length,
                before,
                after: self.trial.energy,
                slope,
            };
            if trial.is_sufficient() {
                self.accept(-length, uphill);
                return true;
            }
            length = trial.next_length();
        }
        false
    }

    fn accept(&mut self, length: f64, direction: &Field) {
        let difference = |k: usize| {
            let (new, old) = (self.trial.gradient[k], self.current.gradient[k]);
            [new[0] - old[0], new[1] - old[1], new[2] - old[2]]
        };
        let change: Field = (0..direction.len())
            .into_par_iter()
            .with_min_len(4 * CHUNK)
            .map(difference)
            .collect();
        let step = direction
            .par_iter()
            .with_min_len(4 * CHUNK)
            .map(|value| value.map(|v| v * length))
            .collect();
        self.memory.push(step, change);
        std::mem::swap(&mut self.current, &mut self.trial);
    }
}
