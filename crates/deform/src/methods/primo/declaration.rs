//! The coupled prisms as one of the methods.

use glam::DVec3;

use super::{Primo, PrimoSolver};
use crate::handles::finite::Finite;
use crate::handles::turns::Followed;
use crate::handles::{Motion, clear};
use crate::method::{BindInput, BoundMethod, DeformMethod, MethodDeclaration, Stepped};
use crate::needs::{ConstraintKind, Needs, Solve};
use crate::{BindError, Picture, SolveError};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "primo",
    title: "Rubber",
    paper: "coupled prisms",
    when_to_use: "Bends like a rubber sheet of a thickness you choose, step by step: for even bends and twists.",
    keywords: "coupled prisms primo rubber nonlinear shell",
    picture: Picture::Prisms,
    slider: None,
    options: Primo::OPTIONS,
    attachments: &[],
    heeds: &[ConstraintKind::Stiffness],
    default: || Primo::default().into(),
    first_choice: || Primo::default().into(),
};

impl DeformMethod for Primo {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    fn counts_in_sizes(&self) -> Option<(&'static str, i32)> {
        Some(("thickness", 1))
    }

    /// Like ARAP, it gives way where the surface twists most.
    fn follows_turns(&self) -> Option<Followed> {
        Some(Followed::by_necks(120.0))
    }

    fn turns_by_moves(&self) -> bool {
        true
    }

    fn needs(&self) -> Needs {
        Needs::Surface {
            // A prism may have free vertices and vertices of a handle, and is coupled with all its neighbours.
            reach: 2,
            // The prisms have their own order of elimination.
            ordering_power: None,
        }
    }

    fn solve(&self) -> Solve {
        Solve::Iterative {
            max_iterations: self.max_iterations,
        }
    }

    fn row_bytes(&self) -> usize {
        // Two prisms, with their joints and their rows of the matrix.
        6000
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        let handles = input.handles;
        let solver = PrimoSolver::bind(
            input.problem,
            self,
            input.partition,
            handles,
            input.progress,
            input.cancel,
        )?;
        Ok(Box::new(solver))
    }
}

impl BoundMethod for PrimoSolver {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        clear(displacements);
        for (own, motion) in self.prescribed.iter().zip(motions) {
            for &(vertex, coordinates) in own {
                displacements[vertex as usize] = motion.displace(coordinates);
            }
        }
        let (converged, energy) = PrimoSolver::step(self, motions, displacements);
        Ok(Stepped {
            converged,
            stalled: self.bodies.has_stalled(),
            energy,
            finite: Finite::Unknown,
        })
    }

    fn rest(&mut self) {
        self.bodies.rest();
    }

    // `energy_of` stays `None`: the energy is the prisms', not the vertices'.

    fn solved_count(&self) -> usize {
        self.vertices.vertices.len()
    }

    fn factor_len(&self) -> usize {
        self.bodies.factor_len()
    }

    /// A step took 17 ms on the bar of [BS08] (5,122 solved vertices, two cores), so a window shows every step.
    fn step_cost(&self) -> usize {
        20 * self.vertices.vertices.len()
    }
}
