//! Gradient-based editing as one of the methods.

use std::sync::Arc;

use glam::DVec3;

use super::{Poisson, PoissonSolver};
use crate::handles::Motion;
use crate::handles::finite::Finite;
use crate::handles::offsets::Offsets;
use crate::handles::polar::Polar;
use crate::method::{BindInput, BoundMethod, DeformMethod, FactoredSystem, MethodDeclaration, Stepped};
use crate::needs::{ConstraintKind, Needs, Solve};
use crate::{BindError, Picture, SolveError, Warning};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "poisson",
    title: "Twists",
    paper: "gradient editing",
    when_to_use: "Spreads the handles' turns and stretches over the surface, in one step and beyond half a turn: for \
                  bends and twists of detailed shapes. A handle that is only moved turns nothing, and details shear \
                  there.",
    keywords: "twist editing poisson gradient harmonic geodesic material propagation",
    picture: Picture::Arrows,
    slider: None,
    options: Poisson::OPTIONS,
    attachments: &[],
    heeds: &[ConstraintKind::SoftHandles, ConstraintKind::Stiffness],
    default: || Poisson::default().into(),
    first_choice: || Poisson::first_choice().into(),
};

impl DeformMethod for Poisson {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    fn advised_for_degrees(&self) -> u16 {
        u16::MAX
    }

    fn needs(&self) -> Needs {
        Needs::Surface {
            reach: 1,
            ordering_power: Some(1),
        }
    }

    fn solve(&self) -> Solve {
        Solve::Direct
    }

    fn takes_places(&self) -> bool {
        true
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        Ok(Box::new(PoissonSolver::bind(self, input)?))
    }
}

impl BoundMethod for PoissonSolver {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        let energy = self.frame(motions, displacements)?;
        Ok(Stepped::at_once(energy, Finite::Unknown))
    }

    fn set_offsets(&mut self, offsets: &Arc<Offsets>) {
        self.system.set_offsets(offsets);
    }

    fn rest(&mut self) {
        self.polars.fill(Polar::default());
    }

    fn energy_of(&self, motions: &[Motion], displacements: &[DVec3]) -> Option<f64> {
        Some(PoissonSolver::energy_of(self, motions, displacements))
    }

    fn weights_of(&self, handle: usize, weights: &mut [f64]) -> bool {
        PoissonSolver::weights_of(self, handle, weights);
        true
    }

    fn system(&self) -> Option<&dyn FactoredSystem> {
        Some(&self.system)
    }

    fn solved_count(&self) -> usize {
        self.system.columns().len()
    }

    fn blind_to(&self, motions: &[Motion]) -> Vec<Warning> {
        crate::handles::only_moved("`poisson`", motions, self.is_held)
            .into_iter()
            .collect()
    }
}
