//! Declares the cage as one of the methods.

use std::f64::consts::PI;

use faer::Mat;
use glam::DVec3;

use super::bound::{BoundCage, Field};
use super::by_hand::{ByHand, kept_bytes};
use super::chosen::ChosenCage;
use super::conformal::Conformal;
use super::fit::{controls, fit_bytes, soft_unit};
use super::green_fit::green_fit_bytes;
use super::green_table::green_bytes;
use super::harmonic::Harmonic;
use super::linear::{HarmonicMap, MeanValueMap, Unit};
use super::mean_value::MeanValue;
use super::outside::{told_close, told_outside};
use super::rows::{harmonic_rows, mean_value_rows};
use super::stored_field::stored_bytes;
use super::{Cage, CageCoordinates, brought};
use crate::BindError;
use crate::Picture;
use crate::attachment::{Attachment, AttachmentDeclaration, AttachmentKind};
use crate::attachment_refused::AttachmentRefused;
use crate::budget::{Limit, bytes_of};
use crate::handles::controls::{Controls, Hand, hand_bytes};
use crate::handles::turns::Followed;
use crate::method::{BindInput, BoundMethod, DeformMethod, MethodDeclaration};
use crate::needs::{ConstraintKind, HandleFit, Needs, Solve};
use crate::space::affine::AffineParts;
use crate::space::falloff::Falloff;
use crate::space::field::{FIELD_ROW, LinearField, moving};
use crate::space::fit_samples::{RegionBox, holds, samples};
use crate::space::point_fit::by_rows;
use crate::sparse::system_error::SystemError;

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "cage",
    title: "Cage",
    paper: "cage coordinates",
    when_to_use: "Bends the space in a coarse cage around the surface: for broad bends of everything inside it, \
                  including loose pieces. The cage fits the handles closely, not exactly; harmonic coordinates keep \
                  limbs that are near each other apart.",
    keywords: "cage mean value harmonic green coordinates conformal space",
    picture: Picture::Hull,
    slider: None,
    options: Cage::OPTIONS,
    attachments: &[AttachmentDeclaration {
        name: "cage",
        title: "cage",
        help: "a cage of your own, a closed mesh of triangles around the region: its `vertices` and `triangles`, or a \
               `file` (OBJ, PLY, OFF, GLB, ..) with them, and the positions to which its vertices are `moved`; \
               without it, one around the region as fine as `detail`",
        kind: AttachmentKind::ControlMesh,
    }],
    heeds: &[ConstraintKind::SoftHandles],
    default: || Cage::default().into(),
    first_choice: || Cage::default().into(),
};

/// The most samples of all handles and the fixed vertices together, and the fewest of each.
const SAMPLES: [usize; 2] = [3000, 50];

/// Like [`SAMPLES`], for coordinates whose frames evaluate each sample.
const SAMPLES_A_FRAME: [usize; 2] = [600, 20];

/// The most steps of a frame by Green coordinates.
const MOST_STEPS: u32 = 1000;

impl DeformMethod for Cage {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    /// Between two turns the field is their mean, which is narrower by the cosine of half the angle.
    fn follows_turns(&self) -> Option<Followed> {
        Some(Followed::by_limbs(90.0))
    }

    fn needs(&self) -> Needs {
        Needs::Points
    }

    fn solve(&self) -> Solve {
        match self.coordinates {
            CageCoordinates::MeanValue | CageCoordinates::Harmonic => Solve::Direct,
            CageCoordinates::Green => Solve::Iterative {
                max_iterations: MOST_STEPS,
            },
        }
    }

    fn handle_fit(&self) -> HandleFit {
        HandleFit::LeastSquares
    }

    fn handle_row_bytes(&self) -> usize {
        match self.coordinates {
            CageCoordinates::MeanValue | CageCoordinates::Harmonic => FIELD_ROW,
            CageCoordinates::Green => 0,
        }
    }

    fn check_attachment(&self, attachment: &Attachment) -> Result<(), AttachmentRefused> {
        brought::check(attachment)
    }

    fn largest_gap_rad(&self) -> f64 {
        PI
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        let within = RegionBox::of(input);
        let unit = Unit {
            world_origin: within.middle(),
            length: within.diagonal,
        };
        let chosen = ChosenCage::of(input, &within, unit, self.detail);
        let (cage, is_brought) = (&chosen.mesh, chosen.is_brought);
        input.cancel.check()?;
        input.progress.set(0.05);
        let solved_count = input.partition.solved.len();
        let over = |limit: Limit| BindError::budget(solved_count, limit);
        let [most, fewest] = match self.coordinates {
            CageCoordinates::Green => SAMPLES_A_FRAME,
            _ => SAMPLES,
        };
        let most = (most / (input.handles.len() + 1)).max(fewest);
        let samples = samples(input, &within, soft_unit(cage), most);
        let of_hand = if is_brought { hand_bytes(cage.vertices.len()) } else { 0 };
        let bytes = fit_bytes(cage.vertices.len(), samples.len()) + of_hand;
        let budget = input.partition.budget.without(bytes).map_err(over)?;
        let affine = AffineParts::fitted(&samples, input.handles, within.middle(), within.diagonal);
        let handles = (input.handles, &*input.partition.soft);
        let world_vertices = &chosen.attachment.rest;
        let controls_of =
            |rows: &Mat<f64>| controls(cage, rows, &samples, handles, &affine, world_vertices, input.cancel);
        let vertices = moving(HandleFit::LeastSquares, input);
        let positions = &input.problem.surface.positions;
        let world_points: Vec<DVec3> = vertices.iter().map(|&vertex| positions[vertex as usize]).collect();
        let mut warnings = Vec::new();
        if is_brought {
            let told = told_outside(self.coordinates, cage, unit, &world_points);
            warnings.extend(told.map_err(of_cage)?);
        }
        let falloff = Falloff::of(input.problem, &vertices, self.falloff * within.diagonal);
        let fit = HandleFit::LeastSquares;
        let (field, rows, driven) = match self.coordinates {
            CageCoordinates::MeanValue => {
                let coordinates = MeanValue::new(cage);
                let rows = mean_value_rows(&coordinates, &samples, unit);
                let driven = controls_of(&rows)?;
                input.progress.set(0.2);
                if is_brought {
                    let bytes = bytes_of(vertices.len(), stored_bytes(cage.vertices.len()));
                    budget.without(bytes).map_err(over)?;
                }
                let map = MeanValueMap {
                    unit,
                    coordinates,
                    controls: &driven,
                };
                let field = LinearField::bind(&map, &falloff, fit, input)?;
                input.progress.set(0.6);
                let by_hand = is_brought
                    .then(|| ByHand::mean_value(&coordinates, unit, (vertices, falloff), &world_points, input));
                let by_hand = by_hand.transpose()?.map(Box::new);
                (Field::Linear(Box::new(field), by_hand), rows, driven)
            }
            CageCoordinates::Harmonic => {
                let part = input.progress.part(0.05, 0.7);
                let budget = match is_brought {
                    true => budget
                        .without(kept_bytes(vertices.len(), cage.vertices.len()))
                        .map_err(over)?,
                    false => budget,
                };
                let step = chosen.voxel / f64::from(self.grid);
                let harmonic = Harmonic::solved(cage, step, budget, &part, input.cancel);
                let harmonic = harmonic.map_err(|failed| {
                    SystemError::of_definite(failed).into_bind_error(input.problem.topology, solved_count)
                })?;
                if is_brought {
                    warnings.extend(told_close(&harmonic, unit, &world_points).map_err(of_cage)?);
                }
                let rows = harmonic_rows(&harmonic, cage.vertices.len(), &samples, unit);
                let driven = controls_of(&rows)?;
                let field = LinearField::bind(&HarmonicMap::new(unit, &harmonic, &driven), &falloff, fit, input)?;
                let by_hand = is_brought.then(|| {
                    let moving = (vertices, falloff);
                    ByHand::harmonic(harmonic, unit, moving, world_points, cage.vertices.len(), input)
                });
                let by_hand = by_hand.transpose()?.map(Box::new);
                (Field::Linear(Box::new(field), by_hand), rows, driven)
            }
            CageCoordinates::Green => {
                let of_fit = green_fit_bytes(cage.vertices.len(), cage.faces.len(), samples.len());
                let bytes = of_fit + green_bytes(cage, vertices.len());
                budget.without(bytes).map_err(over)?;
                let rows = mean_value_rows(&MeanValue::new(cage), &samples, unit);
                let driven = controls_of(&rows)?;
                input.progress.set(0.2);
                let conformal = Conformal::bind(
                    unit,
                    cage.clone(),
                    samples.clone(),
                    affine.clone(),
                    (vertices, falloff),
                    positions,
                    input.progress,
                    input.cancel,
                )?;
                (Field::Conformal(Box::new(conformal)), rows, driven)
            }
        };
        let hand = is_brought.then(|| {
            Hand::new(cage.vertices.len(), &holds(&samples), |sample, visit| {
                (0..cage.vertices.len()).for_each(|vertex| visit(vertex, rows[(sample, vertex)]));
            })
        });
        input.progress.set(1.0);
        Ok(Box::new(BoundCage {
            field,
            controls: Controls {
                rest: chosen.attachment.rest.to_vec(),
                attachment: Attachment::Mesh(chosen.attachment),
                driven: by_rows(&driven),
                hand,
            },
            solved_count,
            warnings,
        }))
    }
}

fn of_cage(refused: AttachmentRefused) -> BindError {
    BindError::Attachment {
        title: DECLARATION.attachments[0].title,
        refused,
    }
}
