//! The cage as one of the methods.

use faer::Mat;
use glam::{DVec3, Mat3};

use super::by_hand::{ByHand, HarmonicCoordinates, StoredCoordinates, stored_bytes};
use super::chosen::ChosenCage;
use super::conformal::{Conformal, row_bytes};
use super::fit::{controls, fit_bytes, response, soft_unit};
use super::harmonic::Harmonic;
use super::linear::{HarmonicMap, MeanValueMap, Unit};
use super::mean_value::MeanValue;
use super::rows::{green_rows, harmonic_rows, mean_value_rows};
use super::{Cage, CageCoordinates, brought};
use crate::budget::{Limit, bytes_of};
use crate::handles::Motion;
use crate::method::{
    Attachment, AttachmentDeclaration, AttachmentKind, AttachmentRefused, BindInput, BoundMethod, ConstraintKind,
    DeformMethod, Finite, HandleFit, MethodDeclaration, Needs, Solve, Stepped,
};
use crate::space::affine::AffineParts;
use crate::space::controls::{Controls, Hand, hand_bytes};
use crate::space::falloff::Falloff;
use crate::space::field::{FIELD_ROW, LinearField, moving};
use crate::space::fit_samples::{RegionBox, samples};
use crate::space::hand_field::HandField;
use crate::sparse::factor_error::FactorError;
use crate::{BindError, SolveError};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "cage",
    title: "Cage",
    when_to_use: "Bends the space in a coarse cage around the surface, which the handles drive: for broad bends of \
                  anything inside it, loose pieces included; with harmonic coordinates limbs that are near \
                  each other stay apart. It fits the handles as well as the cage can, not exactly.",
    keywords: "cage mean value harmonic green coordinates conformal space",
    options: Cage::OPTIONS,
    attachments: &[AttachmentDeclaration {
        name: "cage",
        title: "cage",
        help: "a cage of your own, a closed mesh of triangles around the region: its `vertices` and `triangles`, or the \
               `file` (OBJ, PLY, OFF, GLB, ..) that has them, and where its vertices are `moved` to; without it, one \
               around the region as fine as `detail`",
        kind: AttachmentKind::ControlMesh,
    }],
    heeds: &[ConstraintKind::SoftHandles],
    default: || Cage::default().into(),
    first_choice: || Cage::default().into(),
};

/// The most samples of the handles and of what is fixed, all together, and the fewest of each.
const SAMPLES: [usize; 2] = [3000, 50];

/// As [`SAMPLES`], for coordinates whose frames evaluate each sample.
const SAMPLES_A_FRAME: [usize; 2] = [600, 20];

/// The bound method.
#[derive(Debug)]
struct BoundCage {
    field: Field,
    controls: Controls,
    solved_count: usize,
    warnings: Vec<String>,
}

#[derive(Debug)]
enum Field {
    /// With what the hand does, where the cage was brought.
    Linear(LinearField, Option<ByHand>),
    Conformal(Box<Conformal>),
}

impl DeformMethod for Cage {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    fn needs(&self) -> Needs {
        Needs::Points
    }

    fn solve(&self) -> Solve {
        Solve::Direct
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
        let controls_of =
            |rows: &Mat<f64>| controls(cage, rows, &samples, input.handles, &affine, &chosen.attachment.rest);
        let vertices = moving(HandleFit::LeastSquares, input);
        let positions = &input.problem.surface.positions;
        let world_points: Vec<DVec3> = vertices.iter().map(|&vertex| positions[vertex as usize]).collect();
        let mut warnings = Vec::new();
        if is_brought {
            let points: Vec<DVec3> = world_points.iter().map(|point| unit.local(*point)).collect();
            let are_outside = brought::are_outside(cage, &points);
            warnings.extend(self.told_outside(are_outside.into_iter().filter(|is| *is).count())?);
        }
        let falloff = Falloff::of(input.problem, &vertices, self.falloff * within.diagonal);
        let fit = HandleFit::LeastSquares;
        let (field, rows, driven) = match self.coordinates {
            CageCoordinates::MeanValue => {
                let coordinates = MeanValue::new(cage);
                let rows = mean_value_rows(&coordinates, &samples, unit);
                let driven = controls_of(&rows);
                input.progress.set(0.2);
                let stored = if is_brought {
                    let bytes = bytes_of(vertices.len(), stored_bytes(cage.vertices.len()));
                    budget.without(bytes).map_err(over)?;
                    Some(StoredCoordinates::mean_value(&coordinates, unit, &world_points, input)?)
                } else {
                    None
                };
                input.progress.set(0.6);
                let map = MeanValueMap {
                    unit,
                    coordinates,
                    controls: &driven,
                };
                let field = LinearField::bind(&map, &falloff, fit, input)?;
                let by_hand = stored.map(|map| HandField::new(map, vertices, world_points, falloff));
                (Field::Linear(field, by_hand.map(ByHand::MeanValue)), rows, driven)
            }
            CageCoordinates::Harmonic => {
                let part = input.progress.part(0.05, 0.7);
                let step = chosen.voxel / f64::from(self.grid);
                let harmonic = Harmonic::solved(cage, step, budget, &part, input.cancel);
                let harmonic = harmonic.map_err(|failed| refused(failed, solved_count))?;
                if is_brought {
                    warnings.extend(told_close(&harmonic, unit, &world_points)?);
                }
                let rows = harmonic_rows(&harmonic, cage.vertices.len(), &samples, unit);
                let driven = controls_of(&rows);
                let field = LinearField::bind(&HarmonicMap::new(unit, &harmonic, &driven), &falloff, fit, input)?;
                let by_hand = is_brought.then(|| {
                    let map = HarmonicCoordinates { unit, harmonic };
                    ByHand::Harmonic(HandField::new(map, vertices, world_points, falloff))
                });
                (Field::Linear(field, by_hand), rows, driven)
            }
            CageCoordinates::Green => {
                let bytes = bytes_of(vertices.len(), row_bytes(cage));
                budget.without(bytes).map_err(over)?;
                let rows = mean_value_rows(&MeanValue::new(cage), &samples, unit);
                let (response, driven) = (response(cage, &rows, &samples), controls_of(&rows));
                let green_rows = green_rows(cage, &samples, unit);
                input.progress.set(0.2);
                let conformal = Conformal::bind(
                    unit,
                    cage.clone(),
                    samples.clone(),
                    green_rows,
                    response,
                    (vertices, falloff),
                    positions,
                    input.progress,
                    input.cancel,
                )?;
                (Field::Conformal(Box::new(conformal)), rows, driven)
            }
        };
        let hand = is_brought.then(|| {
            Hand::new(cage.vertices.len(), &samples, |sample, visit| {
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

impl Cage {
    /// What to say of vertices outside a brought cage: mean value coordinates are defined there, the others are not.
    fn told_outside(&self, count: usize) -> Result<Option<String>, BindError> {
        match self.coordinates {
            _ if count == 0 => Ok(None),
            CageCoordinates::MeanValue => Ok(Some(format!(
                "{count} vertices lie outside the cage and may move against it: enlarge the cage around them"
            ))),
            coordinates => Err(of_cage(AttachmentRefused::Outside {
                count,
                coordinates: coordinates.name(),
            })),
        }
    }
}

/// What to say of vertices so near to a brought cage that the harmonic grid has too few nodes around them.
fn told_close(harmonic: &Harmonic, unit: Unit, world_points: &[DVec3]) -> Result<Option<String>, BindError> {
    let around = world_points
        .iter()
        .map(|point| harmonic.nodes_around(unit.local(*point)));
    let (mut none, mut few) = (0, 0);
    for nodes in around {
        none += usize::from(nodes == 0);
        few += usize::from(nodes < 64);
    }
    match (none, few) {
        (0, 0) => Ok(None),
        (0, few) => Ok(Some(format!(
            "{few} vertices lie so close to the cage that they follow it inexactly: move it away from them or raise `grid`"
        ))),
        (count, _) => Err(of_cage(AttachmentRefused::Close { count })),
    }
}

fn of_cage(refused: AttachmentRefused) -> BindError {
    BindError::Attachment {
        title: DECLARATION.attachments[0].title,
        refused,
    }
}

/// A row a vertex and four columns a handle, as entries of one vertex and handle.
fn by_rows(driven: &Mat<f64>) -> Vec<[f64; 4]> {
    let row = |vertex: usize| {
        let handles = 0..driven.ncols() / 4;
        handles.map(move |handle| [0, 1, 2, 3].map(|k| driven[(vertex, 4 * handle + k)]))
    };
    (0..driven.nrows()).flat_map(row).collect()
}

fn refused(failed: FactorError, free_count: usize) -> BindError {
    match failed {
        FactorError::Cancelled => pliant_mesh::Cancelled.into(),
        FactorError::Budget(limit) => BindError::budget(free_count, limit),
        // Its diagonal dominates, so no pivot fails.
        FactorError::Memory | FactorError::Pivot(_) => BindError::OutOfMemory { free_count },
    }
}

impl BoundMethod for BoundCage {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        let finite = match &self.field {
            Field::Linear(field, by_hand) => {
                let finite = field.frame(motions, displacements);
                match (by_hand, self.controls.corrected()) {
                    (Some(by_hand), Some(moves)) => {
                        by_hand.add(moves, displacements);
                        Finite::Unknown
                    }
                    _ => finite,
                }
            }
            Field::Conformal(conformal) => {
                conformal.frame(&self.controls, motions, displacements);
                Finite::Unknown
            }
        };
        Ok(Stepped {
            converged: true,
            energy: 0.0,
            finite,
        })
    }

    fn jacobians(&self, motions: &[Motion], out: &mut [Mat3]) -> bool {
        match &self.field {
            Field::Linear(field, by_hand) => {
                field.jacobians(motions, out);
                if let (Some(by_hand), Some(moves)) = (by_hand, self.controls.corrected()) {
                    by_hand.add_jacobians(moves, out);
                }
            }
            Field::Conformal(conformal) => conformal.jacobians(&self.controls, motions, out),
        }
        true
    }

    fn controls(&self) -> Option<&Controls> {
        Some(&self.controls)
    }

    fn controls_mut(&mut self) -> Option<&mut Controls> {
        Some(&mut self.controls)
    }

    fn control_positions(&self, motions: &[Motion]) -> Vec<DVec3> {
        match &self.field {
            Field::Linear(..) => self.controls.positions(motions),
            Field::Conformal(conformal) => conformal.control_positions(&self.controls, motions),
        }
    }

    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    fn solved_count(&self) -> usize {
        self.solved_count
    }
}
