//! The descent after the linear shape: positions move, and the frames of free vertices always fit them best.
//!
//! E of the positions alone has the gradient A d − b, with the Poisson system of the present frames. A⁻¹ takes it to a
//! plain step, which would fit the positions to the frames [SA07, CPSS10]; the last steps' curvature corrects that,
//! because plain steps alone take thousands to turn what is far from a handle.

use rayon::prelude::*;

use super::FramesSolver;
use super::fitting::fit_to;
use super::state::{Descent, Shape};
use crate::SolveError;
use crate::descent::energy::{Energy, lower};
use crate::descent::rule::{Rule, State};
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::{Field, dot};

/// Iteration ends with a step that promises and gains less than this share of the energy.
const TOLERANCE: f64 = 1e-9;

/// Energies below this are rounding.
const NOTHING: f64 = 1e-24;

/// A decrease by less than this share of the energy may be rounding.
const ROUNDED: f64 = 1e-11;

impl FramesSolver {
    /// Takes one step that lowers the energy, or finds that there is none.
    ///
    /// # Errors
    /// If a solution stays too inaccurate.
    pub(super) fn descend(&mut self) -> Result<State, SolveError> {
        if !self.descent.is_begun {
            self.descent.is_begun = true;
            self.fit();
            self.descent.gradient = self.gradient();
        }
        let lowered = lower(self);
        let rule = Rule {
            tolerance: TOLERANCE,
            nothing: NOTHING,
            rounded: ROUNDED,
        };
        match self.descent.failed.take() {
            Some(error) => Err(error),
            None => Ok(rule.state(lowered, self.shape.energy)),
        }
    }

    /// Fits the frames of free vertices to the positions.
    fn fit(&mut self) {
        let (columns, covariances) = (self.system.columns(), &mut self.scratch.covariances);
        let Shape { frames, field, .. } = &mut self.shape;
        fit_to(&self.gradients, columns, field, covariances, frames);
        self.shape.energy = self.energy(&self.shape.frames, &self.shape.field);
    }

    /// A d − b at the present shape.
    fn gradient(&mut self) -> Field {
        self.find_load();
        self.system.residual(&self.scratch.load, &self.shape.field)
    }

    /// The energy per unit of the system's.
    fn scale(&self) -> f64 {
        let scale = self.system.membrane_stiffness() * self.gradients.scale;
        if scale > 0.0 { scale.recip() } else { 1.0 }
    }
}

impl Energy for FramesSolver {
    fn value(&self) -> f64 {
        self.shape.energy
    }

    fn aim(&mut self) -> f64 {
        let Self { system, descent, .. } = self;
        let Descent {
            memory,
            gradient,
            direction,
            failed,
            ..
        } = descent;
        *direction = memory.direction(gradient, |rows| {
            let mut field: Vec<[f64; 3]> = system.field();
            if let Err(error) = system.solve(rows, &mut field) {
                failed.get_or_insert(error);
            }
            for (row, &local) in rows.iter_mut().zip(system.columns()) {
                *row = field[local as usize];
            }
        });
        -dot(&self.descent.gradient, &self.descent.direction) * self.scale()
    }

    fn try_length(&mut self, length: f64) -> f64 {
        let mut trial = self.descent.trial.take().unwrap_or_else(|| self.shape.clone());
        trial.field.clone_from(&self.shape.field);
        trial.frames.clone_from(&self.shape.frames);
        for (&local, step) in self.system.columns().iter().zip(&self.descent.direction) {
            let own = &mut trial.field[local as usize];
            *own = std::array::from_fn(|k| own[k] - length * step[k]);
        }
        std::mem::swap(&mut self.shape, &mut trial);
        self.fit();
        std::mem::swap(&mut self.shape, &mut trial);
        let energy = trial.energy;
        self.descent.trial = Some(trial);
        energy
    }

    fn accept(&mut self, length: f64) {
        let Some(trial) = self.descent.trial.take() else { return };
        self.descent.trial = Some(std::mem::replace(&mut self.shape, trial));
        let gradient = self.gradient();
        let Descent {
            memory,
            gradient: before,
            direction,
            ..
        } = &mut self.descent;
        let scaled = direction.par_iter().with_min_len(CHUNK);
        let step = scaled.map(|row| row.map(|value| -length * value)).collect();
        let rows = gradient.par_iter().zip(&*before).with_min_len(CHUNK);
        let change = rows
            .map(|(now, before)| std::array::from_fn(|k| now[k] - before[k]))
            .collect();
        memory.push(step, change);
        *before = gradient;
    }

    fn forget(&mut self) -> bool {
        let has_steps = !self.descent.memory.is_empty();
        self.descent.memory.clear();
        has_steps
    }
}
