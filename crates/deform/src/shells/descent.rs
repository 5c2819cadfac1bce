//! One Newton step with a line search, or one quasi-Newton step of a surface that a coarse level leads.

use pliant_mesh::Cancel;

use super::shape::{Energy, Slopes};
use super::system::System;
use super::{Descent, ShellsSolver};
use crate::numerical::line_search::Trial;
use crate::numerical::sums::{Field, dot};
use crate::sparse::factor_error::FactorError;

/// The most lengths that a line search tries.
const TRIALS: u32 = 12;

/// Energies below this share of the surface's area are rounding.
pub(super) const NOTHING: f64 = 1e-20;

/// The decreases that a step promised and reached.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lowered {
    /// The decrease that the quadratic model promised.
    pub promised: f64,
    /// The decrease of the energy; 0 if no length lowered it.
    pub gained: f64,
}

impl ShellsSolver {
    /// Takes one step towards the present motions; the shape must not have converged.
    pub(super) fn descend(&mut self) {
        let is_nothing = self.energy.springs.loads.is_empty() && self.current.energy <= self.nothing();
        if is_nothing || !self.current.energy.is_finite() {
            self.has_converged = true;
            return;
        }
        if !self.has_slopes {
            self.energy.find_slopes(&self.current, &mut self.slopes);
            self.has_slopes = true;
        }
        let Some(mut descent) = self.descent.take() else {
            return;
        };
        match &mut descent {
            Descent::Newton(system) => self.step_newton(system, &Cancel::new()),
            Descent::Led(led) => led.step(self),
        }
        self.descent = Some(descent);
    }

    /// Takes a Newton step. A shape has converged if the quadratic model promises a decrease below the tolerance's
    /// share of the energy and the last step gained less than that too. A cancelled step changes nothing.
    pub(super) fn step_newton(&mut self, system: &mut System, cancel: &Cancel) {
        loop {
            match system.factor(&self.energy, &self.current, &self.slopes, cancel) {
                Ok(()) => {}
                Err(FactorError::Cancelled) => return,
                Err(_) => break,
            }
            let lowered = self.lower(|energy, slopes, x| system.apply(energy, slopes, x));
            // The factor has the curvature; earlier steps only mislead, and with them a scan took three times as many.
            self.memory.clear();
            if lowered.gained > 0.0 {
                system.relax();
                self.has_converged = self.is_little(lowered);
                return;
            }
            if self.is_little(lowered) {
                self.has_converged = true;
                return;
            }
            if !system.damp() {
                break;
            }
        }
        self.has_stalled = true;
    }

    /// True if a step gained next to nothing.
    pub(super) fn is_little(&self, lowered: Lowered) -> bool {
        let enough = self.tolerance * self.current.energy + self.nothing();
        lowered.promised <= enough && lowered.gained <= enough
    }

    fn nothing(&self) -> f64 {
        NOTHING * self.energy.elements.area
    }

    /// Takes a step that lowers the energy, if there is one, on top of `precondition`, which applies an inverse.
    pub(super) fn lower(&mut self, mut precondition: impl FnMut(&Energy, &Slopes, &mut [[f64; 3]])) -> Lowered {
        let before = self.current.energy;
        loop {
            let (energy, slopes) = (&self.energy, &self.slopes);
            let uphill = self
                .memory
                .direction(&slopes.energy, |x| precondition(energy, slopes, x));
            let slope = -dot(&uphill, &slopes.energy);
            let is_lower = slope < 0.0 && self.search(&uphill, slope);
            if is_lower {
                self.learn();
            }
            if is_lower || self.memory.is_empty() {
                return Lowered {
                    promised: -0.5 * slope,
                    gained: before - self.current.energy,
                };
            }
            self.memory.clear();
        }
    }

    /// Moves against `uphill`, by its whole length if that lowers the energy enough. Returns true if some length did.
    fn search(&mut self, uphill: &Field, slope: f64) -> bool {
        let before = self.current.energy;
        let mut length = 1.0;
        for _ in 0..TRIALS {
            self.trial.clone_from(&self.current);
            self.trial.move_by(uphill, -length);
            self.energy.evaluate(&mut self.trial, &self.energy.springs);
            let trial = Trial {
                length,
                before,
                after: self.trial.energy,
                slope,
            };
            if trial.is_sufficient() {
                std::mem::swap(&mut self.current, &mut self.trial);
                return true;
            }
            length = trial.next_length();
        }
        false
    }

    /// Finds the gradient at the current shape and remembers the step from the trial shape to it.
    pub(super) fn learn(&mut self) {
        let before = self.slopes.energy.clone();
        self.energy.find_slopes(&self.current, &mut self.slopes);
        self.has_slopes = true;
        let moved = self.current.displacements.iter().zip(&self.trial.displacements);
        let step: Field = moved
            .take(before.len())
            .map(|(now, then)| (*now - *then).to_array())
            .collect();
        let changed = self.slopes.energy.iter().zip(&before);
        let change = changed
            .map(|(now, then)| std::array::from_fn(|k| now[k] - then[k]))
            .collect();
        self.memory.push(step, change);
    }
}
