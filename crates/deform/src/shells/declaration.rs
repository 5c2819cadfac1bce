//! Discrete shells as one of the methods.

use glam::DVec3;

use super::{Descent, Shells, ShellsSolver};
use crate::handles::{Motion, clear};
use crate::method::{
    BindInput, BoundMethod, ConstraintKind, DeformMethod, Finite, MethodDeclaration, Needs, Solve, Stepped,
};
use crate::{BindError, SolveError};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "shells",
    title: "Discrete shells",
    when_to_use: "Keeps lengths and angles of the surface and, if you wish, its volume, step by step: for what should \
                  bend like a skin, a sheet or a balloon, anywhere between rubber and paper.",
    keywords: "discrete shells nonlinear thin shell paper cloth rubber balloon volume isometric developable grinspun",
    options: Shells::OPTIONS,
    attachments: &[],
    heeds: &[ConstraintKind::SoftHandles, ConstraintKind::Stiffness],
    default: || Shells::default().into(),
    first_choice: || Shells::default().into(),
};

impl DeformMethod for Shells {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    fn needs(&self) -> Needs {
        Needs::Surface {
            // A hinge joins the two vertices across its edge, which may both be constrained.
            reach: 2,
            // Its hinges' own graph is ordered.
            ordering_power: None,
        }
    }

    fn solve(&self) -> Solve {
        Solve::Iterative {
            max_iterations: self.max_iterations,
        }
    }

    fn row_bytes(&self) -> usize {
        1500
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        let solver = ShellsSolver::bind(
            input.problem,
            self,
            input.partition,
            input.handles,
            input.progress,
            input.cancel,
        )?;
        Ok(Box::new(solver))
    }
}

impl BoundMethod for ShellsSolver {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        clear(displacements);
        for (own, motion) in self.prescribed.iter().zip(motions) {
            for vertex in own {
                displacements[vertex.surface_vertex as usize] = motion.displace(vertex.coordinates);
            }
        }
        let mut outcome = (true, 0.0);
        // The pool is entered once: otherwise each of the many short loops would wait for it.
        rayon::scope(|_| outcome = self.advance(motions));
        let solved = &self.energy.elements.vertices[..self.energy.elements.solved_count];
        for (&vertex, displacement) in solved.iter().zip(&self.current.displacements) {
            displacements[vertex as usize] = *displacement;
        }
        let (converged, energy) = outcome;
        Ok(Stepped {
            converged,
            energy,
            finite: Finite::Unknown,
        })
    }

    fn rest(&mut self) {
        self.back_to_rest();
    }

    fn energy_of(&self, motions: &[Motion], displacements: &[DVec3]) -> Option<f64> {
        let mut springs = self.energy.springs.clone();
        springs.aim(motions);
        let mut shape = self.current.clone();
        for (own, &vertex) in shape.displacements.iter_mut().zip(&self.energy.elements.vertices) {
            *own = displacements[vertex as usize];
        }
        self.energy.evaluate(&mut shape, &springs);
        Some(shape.energy * self.energy.unit)
    }

    fn solved_count(&self) -> usize {
        self.energy.elements.solved_count
    }

    fn factor_len(&self) -> usize {
        self.stored()
    }

    /// A Gauss–Newton step factors: 6·10¹⁰ operations take about as long as cheap steps of three million vertices.
    fn step_cost(&self) -> usize {
        let solved = self.energy.elements.solved_count;
        match &self.descent {
            Some(Descent::Newton(system)) => 20 * solved + (5e-5 * system.work()) as usize,
            Some(Descent::Led(_)) | None => 5 * solved,
        }
    }

    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }
}
