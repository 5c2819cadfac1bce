//! One step down.

use glam::DVec3;
use rayon::prelude::*;

use super::shape::Shape;
use super::{ArapSolver, State};
use crate::operators::CHUNK;
use crate::sums::{Field, dot};

/// A step must lower the energy by this share of what its slope promises.
const SUFFICIENT: f64 = 1e-4;

/// Lengths that a line search tries.
const TRIALS: u32 = 10;

/// Energies below this share of the rest shape's scale are rounding.
const NOTHING: f64 = 1e-22;

impl ArapSolver {
    /// Takes one step that lowers the energy, or finds that there is none to take.
    ///
    /// Converged is a shape from which the quadratic model promises less than the tolerance's share of the energy, and
    /// that the last step improved by less than that too. A plain local/global step always descends, in exact
    /// arithmetic: where even that fails, rounding is all that is left.
    pub(super) fn descend(&mut self) {
        loop {
            let preconditioner = &self.preconditioner;
            let uphill = self
                .memory
                .direction(&self.current.gradient, |x| preconditioner.apply(x));
            let slope = -dot(&uphill, &self.current.gradient);
            let before = self.current.energy;
            if slope < 0.0 && self.search(&uphill, slope) {
                let (gained, enough) = (
                    before - self.current.energy,
                    self.options.tolerance * self.current.energy + NOTHING * self.energy.scale(),
                );
                if -0.5 * slope <= enough && gained <= enough {
                    self.state = State::Converged;
                }
                return;
            }
            if self.memory.is_empty() {
                self.state = State::Converged;
                return;
            }
            self.memory.clear();
        }
    }

    /// Moves against `uphill`, by its whole length if that lowers the energy enough; says whether any length did.
    fn search(&mut self, uphill: &Field, slope: f64) -> bool {
        let before = self.current.energy;
        let mut length = 1.0;
        for _ in 0..TRIALS {
            moved(&self.current, uphill, -length, &mut self.trial);
            self.energy.evaluate(&mut self.trial, &mut self.scratch);
            let after = self.trial.energy;
            if after <= before + SUFFICIENT * length * slope && after < before {
                self.accept(-length, uphill);
                return true;
            }
            // The least of the parabola through both energies and the slope.
            let least = -0.5 * slope * length * length / (after - before - slope * length);
            length = if least.is_finite() {
                least.clamp(0.1 * length, 0.5 * length)
            } else {
                0.1 * length
            };
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

/// Makes `trial` the shape at `length` along `direction` from `from`, still to be evaluated.
fn moved(from: &Shape, direction: &Field, length: f64, trial: &mut Shape) {
    trial.rotations.copy_from_slice(&from.rotations);
    let (solved, constrained) = trial.displacements.split_at_mut(direction.len());
    constrained.copy_from_slice(&from.displacements[direction.len()..]);
    solved
        .par_iter_mut()
        .zip(&from.displacements)
        .zip(direction)
        .with_min_len(4 * CHUNK)
        .for_each(|((own, &from), &step)| *own = from + DVec3::from_array(step) * length);
}
