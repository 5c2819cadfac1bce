//! Wrinkles as one of the methods.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use glam::DVec3;

use super::{Wrinkled, Wrinkles};
use crate::attachment::{Attachment, AttachmentDeclaration, AttachmentKind};
use crate::handles::finite::Finite;
use crate::handles::offsets::Offsets;
use crate::handles::turns::Followed;
use crate::handles::{Motion, clear};
use crate::method::{BindInput, BoundMethod, DeformMethod, MethodDeclaration, Stepped};
use crate::methods::bilaplacian::solver::BilaplacianSolver;
use crate::needs::{Needs, Solve};
use crate::operators::triangulation::Triangulation;
use crate::region::boundary_problem::BoundaryProblem;
use crate::{BindError, Picture, ReusableFactor, SolveError};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "wrinkles",
    title: "Wrinkles",
    paper: "pose-space deformation",
    when_to_use: "Bends like a thin plate, in one step, and adds the wrinkles of its examples where the surface is \
                  strained like them: for faces and cloth whose folds you sculpted in a few poses. Without examples \
                  it is the thin plate.",
    keywords: "wrinkles folds creases face facial skin examples pose-space deformation bickel learnt strain detail",
    picture: Picture::Waves,
    slider: None,
    options: Wrinkles::OPTIONS,
    attachments: &[AttachmentDeclaration {
        name: "examples",
        title: "examples",
        help: "further shapes of the same vertices and triangles with wrinkles: a list with the `file` or the \
               `morph_target` of each and its `weight`, which multiplies its wrinkles and is 1 by default",
        kind: AttachmentKind::Shapes,
    }],
    heeds: crate::methods::bilaplacian::DECLARATION.heeds,
    default: || Wrinkles::default().into(),
    first_choice: || Wrinkles::default().into(),
};

impl DeformMethod for Wrinkles {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    fn has_continuity(&self) -> bool {
        self.bending().has_continuity()
    }

    /// Between two turns it is their mean, which is narrower by the cosine of half the angle.
    fn follows_turns(&self) -> Option<Followed> {
        Some(Followed::by_limbs(90.0))
    }

    fn needs(&self) -> Needs {
        self.bending().needs()
    }

    fn solve(&self) -> Solve {
        Solve::Direct
    }

    fn examples_bend(&self) -> bool {
        false
    }

    fn triangulation<'a>(&self, problem: &BoundaryProblem<'a>) -> Triangulation<'a> {
        self.bending().triangulation(problem)
    }

    /// If there are examples, the bases are kept in double precision.
    fn handle_row_bytes(&self) -> usize {
        64
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
        match input.attachment {
            Some(Attachment::Shapes(examples)) if !examples.shapes.is_empty() => {
                Ok(Box::new(Wrinkled::bind(self, examples, input)?))
            }
            _ => Ok(Box::new(BilaplacianSolver::<f32>::bind(&self.bending(), input)?)),
        }
    }
}

impl BoundMethod for Wrinkled {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        if !self.bending.is_affine() {
            return self.step_by_back_substitution(motions, displacements);
        }
        if motions.iter().all(Motion::is_rest) {
            clear(displacements);
        } else {
            self.frame(motions, displacements);
        }
        Ok(Stepped::at_once(self.bending.energy(motions), Finite::Unknown))
    }

    fn step_by_back_substitution(
        &mut self,
        motions: &[Motion],
        displacements: &mut [DVec3],
    ) -> Result<Stepped, SolveError> {
        let energy = self.frame_by_back_substitution(motions, displacements)?;
        Ok(Stepped::at_once(energy, Finite::Unknown))
    }

    fn reusable_factor(&self) -> Option<ReusableFactor> {
        Some(ReusableFactor(Arc::clone(self.bending.factored())))
    }

    fn set_offsets(&mut self, offsets: &Arc<Offsets>) {
        self.bending.set_offsets(offsets);
    }

    fn set_weights(&mut self, weights: &[Option<f64>]) {
        self.give(weights);
    }

    fn weights(&self) -> &[f64] {
        &self.weights
    }

    fn solved_count(&self) -> usize {
        self.patch.rows.len()
    }

    fn factor_len(&self) -> usize {
        self.bending.factor_len()
    }

    fn step_cost(&self) -> usize {
        4 * self.solved_count()
    }

    fn warnings(&self) -> Vec<String> {
        let unlearnt = self.unlearnt.iter().map(|name| {
            format!(
                "most details of the example {name:?} are in places that the handles do not strain, so no pose brings \
                 them back: put a handle where the example moves"
            )
        });
        self.bending.warnings().into_iter().chain(unlearnt).collect()
    }
}
