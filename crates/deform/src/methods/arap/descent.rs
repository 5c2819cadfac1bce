//! ARAP's energy as it descends.

use rayon::prelude::*;

use super::ArapSolver;
use super::end::End;
use super::history::Field;
use super::shape::{Guesses, Shape};
use crate::descent::energy::{Energy, lower};
use crate::descent::rule::Rule;
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::CHUNKS_A_TASK;

/// Energies below this share of the rest shape's scale are rounding of rotations and gradients in single precision.
const NOTHING: f64 = 3.6e-15;

/// A decrease by less than this share of the energy may be rounding of rotations and gradients in single precision.
const ROUNDED: f64 = 1e-6;

impl ArapSolver {
    /// Takes one step that lowers the energy, or finds that there is none.
    pub(super) fn descend(&mut self) {
        self.finish_step();
        self.map_gradient();
        let rule = Rule {
            tolerance: self.options.tolerance,
            nothing: NOTHING * self.cells.scale,
            rounded: ROUNDED,
        };
        let lowered = lower(self);
        self.state = rule.state(lowered, self.current.energy);
    }

    /// Computes the gradient at the end of the last step, and adds the step to the history.
    pub(super) fn finish_step(&mut self) {
        let end = std::mem::take(&mut self.end);
        if matches!(end, End::Known) {
            return;
        }
        self.cells.find_gradient(&mut self.current, &self.scratch);
        self.current.add_gradient_of(&self.springs);
        let End::Stepped(length) = end else { return };
        self.history.stepped(length, &mut self.direction);
    }

    /// The plain step for the gradient.
    pub(super) fn map_gradient(&mut self) {
        let gradient = &self.current.gradient;
        self.history.mapped.resize(gradient.len(), [0.0; 3]);
        self.preconditioner.map(gradient, &mut self.history.mapped);
    }
}

impl Energy for ArapSolver {
    fn value(&self) -> f64 {
        self.current.energy
    }

    fn aim(&mut self) -> f64 {
        let factors = self.history.factors(&self.trial.gradient, &self.current.gradient);
        let along = self
            .history
            .direction(&factors, &self.current.gradient, &mut self.direction);
        -along * self.unit * self.unit
    }

    fn try_length(&mut self, length: f64) -> f64 {
        moved(&self.current, &self.direction, -length * self.unit, &mut self.trial);
        let guesses = Guesses::Given(&self.current.rotations);
        self.cells.measure(&mut self.trial, guesses, &mut self.scratch);
        self.trial.add_energy_of(&self.springs);
        self.trial.energy
    }

    fn accept(&mut self, length: f64) {
        self.end = End::Stepped(length);
        std::mem::swap(&mut self.current, &mut self.trial);
    }

    fn forget(&mut self) -> bool {
        let has_steps = !self.history.is_empty();
        if has_steps {
            self.history.clear();
        }
        has_steps
    }
}

/// Makes `trial` the shape at `length` along `direction` from `from`, still to be evaluated.
fn moved(from: &Shape, direction: &Field, length: f64, trial: &mut Shape) {
    let (solved, constrained) = trial.displacements.split_at_mut(direction.len());
    constrained.copy_from_slice(&from.displacements[direction.len()..]);
    solved
        .par_chunks_mut(CHUNK)
        .zip(from.displacements[..direction.len()].par_chunks(CHUNK))
        .zip(direction.par_chunks(CHUNK))
        .with_min_len(CHUNKS_A_TASK)
        .for_each(|((own, from), direction)| {
            for ((own, from), step) in own.iter_mut().zip(from).zip(direction) {
                for k in 0..3 {
                    own[k] = from[k] + f64::from(step[k]) * length;
                }
            }
        });
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use glam::{DAffine3, DVec3};
    use pliant_mesh::{Cancel, Progress, shapes};

    use super::super::ArapSolver;
    use crate::descent::rule::State;
    use crate::handles::Handle;
    use crate::region::boundary_problem::BoundaryProblem;
    use crate::{Arap, ArapEnergy, Method, Role};

    #[test]
    fn a_shape_from_which_no_step_leads_down_has_stalled_and_not_converged() {
        let model = shapes::model(shapes::tube(12, 16, 5.0));
        let role = |p: &DVec3| match p.z {
            z if z < 0.5 => Role::Fixed,
            z if z > 4.5 => Role::Handle(0),
            _ => Role::Free,
        };
        let roles: Vec<Role> = model.surface.positions.iter().map(role).collect();
        for energy in [ArapEnergy::Spokes, ArapEnergy::SpokesAndRims, ArapEnergy::Smooth] {
            let options = Arap {
                energy,
                ..Arap::default()
            };
            let method = Method::from(options.clone());
            let stiffness = vec![1.0; roles.len()];
            let problem = BoundaryProblem::new((&model.surface, &model.topology), &roles, &stiffness);
            let (progress, cancel) = (Progress::new(), Cancel::new());
            let ordering = method.ordering(&model.topology, &progress, &cancel).unwrap().unwrap();
            let partition = method.partition(&problem).unwrap();
            let handles = [Handle::new(partition.handles[0].clone(), &model.surface.positions)];
            let mut solver =
                ArapSolver::bind(&problem, &options, &partition, &handles, &ordering, &progress, &cancel).unwrap();
            let target = DAffine3::from_translation(DVec3::X) * DAffine3::from_rotation_x(1.0);
            let motions = [handles[0].motion(&target)];
            solver.step(&motions);
            assert!(solver.state == State::Descending);
            // No trial has a lower energy.
            solver.current.energy *= 1e-3;
            solver.history.clear();
            solver.step(&motions);
            assert!(solver.has_stalled(), "{energy:?}");
        }
    }
}
