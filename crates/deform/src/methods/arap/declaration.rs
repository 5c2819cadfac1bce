//! ARAP as one of the methods.

use std::sync::Arc;

use glam::DVec3;

use super::lead::LedSolver;
use super::{Arap, ArapEnergy};
use crate::descent::prescribed::Prescribed;
use crate::handles::finite::Finite;
use crate::handles::offsets::Offsets;
use crate::handles::turns::Followed;
use crate::handles::{Motion, clear};
use crate::method::{BindInput, BoundMethod, DeformMethod, MethodDeclaration, Stepped};
use crate::needs::{ConstraintKind, Needs, Solve};
use crate::operators::repairs;
use crate::{BindError, OptionSlider, Picture, SolveError};

/// From a hundredth of the default to a hundred times it: the logarithmic slider begins in its middle.
const RIGID_TO_SMOOTH: OptionSlider = OptionSlider {
    option: "smoothness",
    ends: ["Rigid", "smooth"],
    range: [3e-5, 0.3],
    help: "Rigid keeps details and bends only where it must; smooth spreads the bend evenly. The slider sets `smoothness`.",
};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "arap",
    title: "Limbs",
    paper: "as rigid as possible",
    when_to_use: "Keeps every neighbourhood as rigid as possible, step by step, for large turns and long drags. The \
                  energy \"smooth\" bends and twists evenly; \"spokes-and-rims\" binds sooner and may crease.",
    keywords: "limb as rigid as possible arap as-rigid-as-possible",
    picture: Picture::Blocks,
    slider: Some(&RIGID_TO_SMOOTH),
    options: Arap::OPTIONS,
    attachments: &[],
    heeds: &[ConstraintKind::SoftHandles, ConstraintKind::Stiffness],
    default: || Arap::default().into(),
    first_choice: || Arap::first_choice().into(),
};

impl DeformMethod for Arap {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    /// A neck can be so short that stretching it costs less than the twist around it, unless the smooth energy's barrier
    /// makes that dear. In a sharp fold its cross-section becomes oval, and a crease where bending is free.
    fn follows_turns(&self) -> Option<Followed> {
        match self.energy {
            ArapEnergy::Spokes | ArapEnergy::SpokesAndRims => Some(Followed::by_folds_and_necks(95.0, 140.0)),
            ArapEnergy::Smooth => Some(Followed::by_folds(140.0)),
        }
    }

    fn advised_for_degrees(&self) -> u16 {
        match self.energy {
            ArapEnergy::Spokes | ArapEnergy::SpokesAndRims => 95,
            ArapEnergy::Smooth => 140,
        }
    }

    fn turns_by_moves(&self) -> bool {
        true
    }

    fn needs(&self) -> Needs {
        Needs::Surface {
            // Across constrained vertices, too: their cells turn with all their neighbours.
            reach: 2,
            ordering_power: Some(self.operator_power()),
        }
    }

    fn solve(&self) -> Solve {
        Solve::Iterative {
            max_iterations: self.max_iterations,
        }
    }

    fn row_bytes(&self) -> usize {
        750
    }

    fn takes_places(&self) -> bool {
        true
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        let (ordering, handles) = (input.ordering()?, input.handles);
        let solver = LedSolver::bind(
            input.problem,
            self,
            input.partition,
            handles,
            ordering,
            input.progress,
            input.cancel,
        )?;
        Ok(Box::new(solver))
    }
}

impl BoundMethod for LedSolver {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        clear(displacements);
        Prescribed::write(&self.solver.prescribed, motions, displacements);
        let (converged, energy) = LedSolver::step(self, motions, displacements);
        Ok(Stepped {
            converged,
            stalled: self.solver.has_stalled(),
            energy,
            finite: Finite::Unknown,
        })
    }

    fn set_offsets(&mut self, offsets: &Arc<Offsets>) {
        LedSolver::set_offsets(self, offsets);
    }

    fn rest(&mut self) {
        LedSolver::rest(self);
    }

    fn begin_at(&mut self, motions: &[Motion], displacements: &[DVec3]) -> bool {
        LedSolver::begin_at(self, motions, displacements);
        true
    }

    fn energy_of(&self, motions: &[Motion], displacements: &[DVec3]) -> Option<f64> {
        Some(self.solver.energy_of(motions, displacements))
    }

    fn solved_count(&self) -> usize {
        self.solver.domain.solved_count
    }

    fn factor_len(&self) -> usize {
        LedSolver::factor_len(self)
    }

    fn warnings(&self) -> Vec<String> {
        repairs(self.solver.mollified_faces).into_iter().collect()
    }
}
