//! Shells' energy as it descends: by one Newton step, or by one quasi-Newton step of a surface that a coarse level leads.

use pliant_mesh::Cancel;

use super::shape::{Energy, Slopes};
use super::system::System;
use super::{Descent, ShellsSolver};
use crate::descent;
use crate::descent::energy::lower;
use crate::descent::rule::{Lowered, Rule, State};
use crate::numerical::sums::{Field, dot};
use crate::sparse::factor_error::FactorError;

impl ShellsSolver {
    /// Takes one step towards the present motions; the shape must not have converged.
    pub(super) fn descend(&mut self) {
        let is_minimum = self.energy.springs.loads.is_empty() && self.is_unstrained();
        if is_minimum || !self.current.energy.is_finite() {
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

    /// Takes a Newton step. A cancelled step changes nothing.
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
            }
            let state = self.rule().state(lowered, self.current.energy);
            if state != State::Stalled {
                self.has_converged = state == State::Converged;
                return;
            }
            if !system.damp() {
                break;
            }
        }
        self.has_stalled = true;
    }

    /// The rule of convergence.
    pub(super) fn rule(&self) -> Rule {
        Rule {
            tolerance: self.tolerance,
            nothing: self.nothing,
            rounded: 0.0,
        }
    }

    /// Whether the energy is that of rounding.
    pub(super) fn is_unstrained(&self) -> bool {
        self.current.energy <= self.nothing
    }

    /// Takes a step that lowers the energy, if there is one, on top of `precondition`, which applies an inverse.
    pub(super) fn lower(&mut self, precondition: impl FnMut(&Energy, &Slopes, &mut [[f64; 3]])) -> Lowered {
        lower(&mut Step {
            solver: self,
            precondition,
            uphill: Field::new(),
        })
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

/// A step on top of an inverse.
struct Step<'a, P> {
    solver: &'a mut ShellsSolver,
    /// Applies the inverse.
    precondition: P,
    uphill: Field,
}

impl<P: FnMut(&Energy, &Slopes, &mut [[f64; 3]])> descent::energy::Energy for Step<'_, P> {
    fn value(&self) -> f64 {
        self.solver.current.energy
    }

    fn aim(&mut self) -> f64 {
        let ShellsSolver {
            energy, slopes, memory, ..
        } = &*self.solver;
        let precondition = &mut self.precondition;
        self.uphill = memory.direction(&slopes.energy, |x| precondition(energy, slopes, x));
        -dot(&self.uphill, &slopes.energy)
    }

    fn try_length(&mut self, length: f64) -> f64 {
        let ShellsSolver {
            current, trial, energy, ..
        } = &mut *self.solver;
        trial.clone_from(current);
        trial.move_by(&self.uphill, -length);
        energy.evaluate(trial, &energy.springs);
        trial.energy
    }

    fn accept(&mut self, _: f64) {
        std::mem::swap(&mut self.solver.current, &mut self.solver.trial);
        self.solver.learn();
    }

    fn forget(&mut self) -> bool {
        let has_steps = !self.solver.memory.is_empty();
        self.solver.memory.clear();
        has_steps
    }
}
