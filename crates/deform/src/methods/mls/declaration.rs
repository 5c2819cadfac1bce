//! Moving least squares as one of the methods.

use std::f64::consts::FRAC_PI_2;

use super::bound::{BoundTurning, TURNING_ROW, bind_affine};
use super::fit::Turning;
use super::moments::Entry;
use super::points::Points;
use super::{Mls, MlsTransforms};
use crate::BindError;
use crate::Picture;
use crate::handles::turns::Followed;
use crate::method::{BindInput, BoundMethod, DeformMethod, MethodDeclaration};
use crate::needs::{ConstraintKind, Needs, Solve};
use crate::space::field::FIELD_ROW;

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "mls",
    title: "Quick space",
    paper: "moving least squares",
    when_to_use: "Turns and moves each place like the handles around it, in one step: for quick poses of scans of \
                  loose or broken pieces. Everything near in space moves along, connected or not.",
    keywords: "mls moving least squares schaefer rigid similarity affine space points soup warp",
    picture: Picture::Moves,
    slider: None,
    options: Mls::OPTIONS,
    attachments: &[],
    heeds: &[ConstraintKind::SoftHandles],
    default: || Mls::default().into(),
    first_choice: || Mls::default().into(),
};

impl DeformMethod for Mls {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    /// If several handles have equal weights, no rotation fits all of them.
    fn follows_turns(&self) -> Option<Followed> {
        Some(Followed::by_seams(90.0))
    }

    fn needs(&self) -> Needs {
        Needs::Points
    }

    fn solve(&self) -> Solve {
        Solve::Direct
    }

    fn row_bytes(&self) -> usize {
        match self.transforms {
            MlsTransforms::Affine => 300,
            MlsTransforms::Similarity | MlsTransforms::Rigid => TURNING_ROW,
        }
    }

    fn handle_row_bytes(&self) -> usize {
        match self.transforms {
            MlsTransforms::Affine => FIELD_ROW,
            MlsTransforms::Similarity | MlsTransforms::Rigid => size_of::<Entry>(),
        }
    }

    fn largest_gap_rad(&self) -> f64 {
        FRAC_PI_2
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        let points = Points::of(input);
        input.progress.set(0.1);
        let half_falloff = 0.5 * self.falloff;
        let bound: Box<dyn BoundMethod> = match self.transforms {
            MlsTransforms::Affine => Box::new(bind_affine(&points, half_falloff, input)?),
            MlsTransforms::Similarity => {
                Box::new(BoundTurning::bind(Turning::Similarity, &points, half_falloff, input)?)
            }
            MlsTransforms::Rigid => Box::new(BoundTurning::bind(Turning::Rigid, &points, half_falloff, input)?),
        };
        input.progress.set(1.0);
        Ok(bound)
    }
}
