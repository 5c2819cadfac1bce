//! One descent step with a line search.

use rayon::prelude::*;

use super::ArapSolver;
use super::history::Field;
use super::shape::{Guesses, Shape};
use super::state::{End, State};
use crate::numerical::line_search::Trial;
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::CHUNKS_A_TASK;

/// Lengths that a line search tries.
const TRIALS: u32 = 10;

/// Energies below this share of the rest shape's scale are rounding of rotations and gradients in single precision.
const NOTHING: f64 = 3.6e-15;

/// A decrease by less than this share of the energy may be rounding of rotations and gradients in single precision.
const ROUNDED: f64 = 1e-6;

impl ArapSolver {
    /// Takes one step that lowers the energy, or finds that there is none.
    ///
    /// A shape has converged if the quadratic model promises a decrease below the tolerance's share of the energy and
    /// the last step gained less than that too. In exact arithmetic a plain local/global step always descends: if even
    /// that fails and promises little, only rounding is left; if it promises more, the descent has stalled.
    pub(super) fn descend(&mut self) {
        self.finish_step();
        self.map_gradient();
        loop {
            let factors = self.history.factors(&self.trial.gradient, &self.current.gradient);
            let along = self
                .history
                .direction(&factors, &self.current.gradient, &mut self.direction);
            let slope = -along * self.unit * self.unit;
            let before = self.current.energy;
            if slope < 0.0 && self.search(slope) {
                let (gained, enough) = (
                    before - self.current.energy,
                    self.options.tolerance * self.current.energy + NOTHING * self.cells.scale,
                );
                if -0.5 * slope <= enough && gained <= enough {
                    self.state = State::Converged;
                }
                return;
            }
            if self.history.is_empty() {
                let little = self.options.tolerance.max(ROUNDED) * before + NOTHING * self.cells.scale;
                let is_little = -0.5 * slope <= little;
                self.state = if is_little { State::Converged } else { State::Stalled };
                return;
            }
            self.history.clear();
        }
    }

    /// Computes the gradient at the end of the last step, and adds the step to the history.
    pub(super) fn finish_step(&mut self) {
        let end = std::mem::take(&mut self.end);
        if matches!(end, End::Known) {
            return;
        }
        self.cells.find_gradient(&mut self.current, &self.scratch);
        self.springs.add_gradient(&mut self.current);
        let End::Stepped(length) = end else { return };
        self.history.stepped(length, &mut self.direction);
    }

    /// The plain step for the gradient.
    pub(super) fn map_gradient(&mut self) {
        let gradient = &self.current.gradient;
        self.history.mapped.resize(gradient.len(), [0.0; 3]);
        self.preconditioner
            .map(gradient, &mut self.history.mapped, &mut self.map_room);
    }

    /// Moves against the direction, by its whole length if that lowers the energy enough. Returns whether any length
    /// did.
    fn search(&mut self, slope: f64) -> bool {
        let before = self.current.energy;
        let mut length = 1.0;
        for _ in 0..TRIALS {
            moved(&self.current, &self.direction, -length * self.unit, &mut self.trial);
            let guesses = Guesses::Given(&self.current.rotations);
            self.cells.measure(&mut self.trial, guesses, &mut self.scratch);
            self.springs.add_energy(&mut self.trial);
            let trial = Trial {
                length,
                before,
                after: self.trial.energy,
                slope,
            };
            if trial.is_sufficient() {
                self.end = End::Stepped(length);
                std::mem::swap(&mut self.current, &mut self.trial);
                return true;
            }
            length = trial.next_length();
        }
        false
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
    use crate::handles::Handle;
    use crate::region::boundary_problem::BoundaryProblem;
    use crate::{Arap, ArapEnergy, Constraints, Loose, Method, Role};

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
            let problem = BoundaryProblem {
                surface: &model.surface,
                topology: &model.topology,
                roles: &roles,
                handle_count: 1,
                stiffness: &vec![1.0; roles.len()],
                constraints: Constraints::default(),
                loose: Loose::Rest,
                examples: None,
            };
            let (progress, cancel) = (Progress::new(), Cancel::new());
            let ordering = method.ordering(&model.topology, &progress, &cancel).unwrap().unwrap();
            let partition = method.partition(&problem).unwrap();
            let handles = [Handle::new(partition.handles[0].clone(), &model.surface.positions)];
            let mut solver =
                ArapSolver::bind(&problem, &options, &partition, &handles, &ordering, &progress, &cancel).unwrap();
            let target = DAffine3::from_translation(DVec3::X) * DAffine3::from_rotation_x(1.0);
            let motions = [handles[0].motion(&target)];
            let mut displacements = vec![DVec3::ZERO; roles.len()];
            assert!(!solver.step(&motions, &mut displacements).0);
            // No trial has a lower energy.
            solver.current.energy *= 1e-3;
            solver.history.clear();
            let (converged, _) = solver.step(&motions, &mut displacements);
            assert!(!converged && solver.has_stalled(), "{energy:?}");
        }
    }
}
