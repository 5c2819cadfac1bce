//! The bi-Laplacian as one of the methods.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use glam::DVec3;

use crate::handles::Motion;
use crate::handles::finite::Finite;
use crate::handles::offsets::Offsets;
use crate::handles::turns::Followed;
use crate::method::{BindInput, BoundMethod, DeformMethod, MethodDeclaration, Stepped};
use crate::methods::bilaplacian::detail::Multiresolution;
use crate::methods::bilaplacian::solver::BilaplacianSolver;
use crate::needs::{ConstraintKind, Needs, Solve};
use crate::operators::triangulation::Triangulation;
use crate::option::{OptionRefused, OptionSlider};
use crate::region::boundary_problem::BoundaryProblem;
use crate::{Bilaplacian, BindError, Detail, HandleBases, Picture, ReusableFactor, SolveError};

const FINE_TO_SMOOTH: OptionSlider = OptionSlider {
    option: "base_length",
    ends: ["Fine", "smooth"],
    range: Bilaplacian::FINE_TO_SMOOTH,
    help: "The smooth surface below the details: the smoother it is, the larger the details that turn with it, but limbs \
           shrink to lines. The slider sets `base_length`.",
};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "bilaplacian",
    title: "Soft",
    paper: "thin plate",
    when_to_use: "Bends like a thin plate, in one step: for small turns and smooth bulges.",
    keywords: "thin plate bilaplacian bi-laplacian biharmonic linear shell laplacian",
    picture: Picture::Plate,
    slider: Some(&FINE_TO_SMOOTH),
    options: Bilaplacian::OPTIONS,
    attachments: &[],
    heeds: &[
        ConstraintKind::SoftHandles,
        ConstraintKind::Continuity,
        ConstraintKind::Stiffness,
    ],
    default: || Bilaplacian::default().into(),
    first_choice: || Bilaplacian::default().into(),
};

impl DeformMethod for Bilaplacian {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    fn has_continuity(&self) -> bool {
        self.operator_power() > 1
    }

    fn counts_in_sizes(&self) -> Option<(&'static str, i32)> {
        (self.stretching > 0.0).then_some(("stretching", -2))
    }

    /// Between two turns it is their mean, which is narrower by the cosine of half the angle; a base that has shrunk to a
    /// line at a neck narrows it more.
    fn follows_turns(&self) -> Option<Followed> {
        Some(Followed::by_limbs(match self.detail {
            Detail::DeformationTransfer => 65.0,
            Detail::None | Detail::NormalDisplacements | Detail::DisplacementVolumes => 90.0,
        }))
    }

    fn needs(&self) -> Needs {
        Needs::Surface {
            reach: self.operator_power(),
            ordering_power: Some(self.ordering_power()),
        }
    }

    fn solve(&self) -> Solve {
        Solve::Direct
    }

    fn check(&self) -> Result<(), OptionRefused> {
        if self.bending + self.stretching > 0.0 {
            return Ok(());
        }
        Err(OptionRefused {
            option: "bending".to_owned(),
            allowed: "a number above 0 if `stretching` is 0".to_owned(),
        })
    }

    fn triangulation<'a>(&self, problem: &BoundaryProblem<'a>) -> Triangulation<'a> {
        let may_move = |vertex| problem.may_move(vertex);
        let (surface, topology) = (problem.surface, problem.topology);
        Triangulation::stretched(surface, topology, self.triangulation, self.anisotropy, &may_move)
    }

    fn takes_first_power(&self) -> bool {
        self.operator_power() == 2 && self.stretching == 0.0 && self.detail == Detail::None
    }

    fn row_bytes(&self) -> usize {
        match self.detail {
            Detail::None => 300,
            Detail::NormalDisplacements => 900,
            Detail::DisplacementVolumes => 1100,
            Detail::DeformationTransfer => 1300,
        }
    }

    /// If details are put back, the bases are kept in double precision.
    fn handle_row_bytes(&self) -> usize {
        match self.detail {
            Detail::None => 32,
            _ => 64,
        }
    }

    fn takes_places(&self) -> bool {
        true
    }

    fn takes_turns(&self) -> bool {
        false
    }

    fn largest_gap_rad(&self) -> f64 {
        FRAC_PI_2
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        Ok(match self.detail {
            Detail::None => Box::new(BilaplacianSolver::<f32>::bind(self, input)?),
            _ => Box::new(Multiresolution::bind(self, input)?),
        })
    }
}

impl BoundMethod for BilaplacianSolver {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        if !self.is_affine() {
            return self.step_by_back_substitution(motions, displacements);
        }
        let finite = self.frame(motions, displacements);
        Ok(Stepped::at_once(self.energy(motions), finite))
    }

    fn step_by_back_substitution(
        &mut self,
        motions: &[Motion],
        displacements: &mut [DVec3],
    ) -> Result<Stepped, SolveError> {
        self.frame_by_back_substitution(motions, displacements)?;
        Ok(Stepped::at_once(
            BilaplacianSolver::energy_of(self, motions, displacements),
            Finite::Unknown,
        ))
    }

    fn set_offsets(&mut self, offsets: &Arc<Offsets>) {
        BilaplacianSolver::set_offsets(self, offsets);
    }

    fn energy_of(&self, motions: &[Motion], displacements: &[DVec3]) -> Option<f64> {
        Some(BilaplacianSolver::energy_of(self, motions, displacements))
    }

    fn handle_bases(&self) -> Option<&HandleBases> {
        self.is_driven_by_handles_alone().then(|| self.bases())
    }

    fn reusable_factor(&self) -> Option<ReusableFactor> {
        Some(ReusableFactor(Arc::clone(self.factored())))
    }

    fn solved_count(&self) -> usize {
        self.bases().vertices().len()
    }

    fn factor_len(&self) -> usize {
        BilaplacianSolver::factor_len(self)
    }

    fn warnings(&self) -> Vec<String> {
        BilaplacianSolver::warnings(self)
    }
}
