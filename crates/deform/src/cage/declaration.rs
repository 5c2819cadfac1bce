//! The cage as one of the methods.

use faer::Mat;
use glam::{DVec3, Mat3};

use super::conformal::{Conformal, row_bytes};
use super::fit::{controls, fit_bytes, response, soft_unit};
use super::green::Green;
use super::harmonic::Harmonic;
use super::linear::{HarmonicMap, MeanValueMap, Unit};
use super::mean_value::MeanValue;
use super::mesh::CageMesh;
use super::offset::{OffsetCage, offset_cage};
use super::{Cage, CageCoordinates};
use crate::budget::{Limit, bytes_of};
use crate::handles::Motion;
use crate::method::{
    BindInput, BoundMethod, ConstraintKind, DeformMethod, Finite, HandleFit, MethodDeclaration, Needs, Solve, Stepped,
};
use crate::space::affine::AffineParts;
use crate::space::falloff::Falloff;
use crate::space::field::{FIELD_ROW, LinearField, moving};
use crate::space::fit_samples::{RegionBox, Sample, samples};
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
    solved_count: usize,
}

#[derive(Debug)]
enum Field {
    Linear(LinearField),
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

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        let within = RegionBox::of(input);
        let unit = Unit {
            world_origin: within.middle(),
            length: within.diagonal,
        };
        let OffsetCage { mesh: cage, voxel } = made(self.detail, input, &within, unit);
        input.cancel.check()?;
        input.progress.set(0.05);
        let solved_count = input.partition.solved.len();
        let over = |limit: Limit| BindError::budget(solved_count, limit);
        let [most, fewest] = match self.coordinates {
            CageCoordinates::Green => SAMPLES_A_FRAME,
            _ => SAMPLES,
        };
        let most = (most / (input.handles.len() + 1)).max(fewest);
        let samples = samples(input, &within, soft_unit(&cage), most);
        let bytes = fit_bytes(cage.vertices.len(), samples.len());
        let budget = input.partition.budget.without(bytes).map_err(over)?;
        let affine = AffineParts::fitted(&samples, input.handles, within.middle(), within.diagonal);
        let world_vertices: Vec<DVec3> = cage.vertices.iter().map(|vertex| unit.world(*vertex)).collect();
        let controls_of = |rows: &Mat<f64>| controls(&cage, rows, &samples, input.handles, &affine, &world_vertices);
        let vertices = moving(HandleFit::LeastSquares, input);
        let falloff = Falloff::of(input.problem, &vertices, self.falloff * within.diagonal);
        let fit = HandleFit::LeastSquares;
        let field = match self.coordinates {
            CageCoordinates::MeanValue => {
                let coordinates = MeanValue::new(&cage);
                let controls = controls_of(&mean_value_rows(&coordinates, &samples, unit));
                input.progress.set(0.2);
                let map = MeanValueMap {
                    unit,
                    coordinates,
                    controls: &controls,
                };
                Field::Linear(LinearField::bind(&map, &falloff, fit, input)?)
            }
            CageCoordinates::Harmonic => {
                let part = input.progress.part(0.05, 0.7);
                let step = voxel / f64::from(self.grid);
                let harmonic = Harmonic::solved(&cage, step, budget, &part, input.cancel);
                let harmonic = harmonic.map_err(|failed| refused(failed, solved_count))?;
                let own: Vec<Vec<f64>> = samples
                    .iter()
                    .map(|sample| harmonic.at(unit.local(sample.world_point)))
                    .collect();
                let rows = Mat::from_fn(samples.len(), cage.vertices.len(), |sample, vertex| own[sample][vertex]);
                let controls = controls_of(&rows);
                let map = HarmonicMap::new(unit, &harmonic, &controls);
                Field::Linear(LinearField::bind(&map, &falloff, fit, input)?)
            }
            CageCoordinates::Green => {
                let bytes = bytes_of(vertices.len(), row_bytes(&cage));
                budget.without(bytes).map_err(over)?;
                let rows = mean_value_rows(&MeanValue::new(&cage), &samples, unit);
                let (response, controls) = (response(&cage, &rows, &samples), controls_of(&rows));
                let rows = green_rows(&cage, &samples, unit);
                input.progress.set(0.2);
                Field::Conformal(Box::new(Conformal::bind(
                    unit,
                    cage,
                    samples,
                    rows,
                    response,
                    controls,
                    (vertices, falloff),
                    &input.problem.surface.positions,
                    input.progress,
                    input.cancel,
                )?))
            }
        };
        input.progress.set(1.0);
        Ok(Box::new(BoundCage { field, solved_count }))
    }
}

/// The cage around everything in the region's box, in the cage's unit.
fn made(detail: u32, input: &BindInput<'_>, within: &RegionBox, unit: Unit) -> OffsetCage {
    let surface = input.problem.surface;
    let position = |vertex: usize| surface.positions[vertex];
    let points: Vec<DVec3> = surface
        .positions
        .iter()
        .filter(|point| within.contains(**point))
        .map(|point| unit.local(*point))
        .collect();
    let triangles = surface
        .triangles
        .iter()
        .map(|corners| corners.map(|corner| position(corner.index())));
    let triangles = triangles.filter(|corners| corners.iter().all(|corner| within.contains(*corner)));
    offset_cage(
        &points,
        triangles.map(|corners| corners.map(|corner| unit.local(corner))),
        detail,
    )
}

/// The samples' mean value coordinates, a row a sample.
fn mean_value_rows(coordinates: &MeanValue<'_>, samples: &[Sample], unit: Unit) -> Mat<f64> {
    let points: Vec<DVec3> = samples.iter().map(|sample| unit.local(sample.world_point)).collect();
    let mut rows = Mat::zeros(points.len(), coordinates.count());
    coordinates.at(&points, |sample, weights| {
        for (vertex, (weight, _)) in weights.iter().enumerate() {
            rows[(sample, vertex)] = *weight;
        }
    });
    rows
}

/// The samples' Green coordinates, a row a sample.
fn green_rows(cage: &CageMesh, samples: &[Sample], unit: Unit) -> Mat<f64> {
    let green = Green::new(cage);
    let mut rows = Mat::zeros(samples.len(), green.count());
    let mut values = vec![0.0; green.count()];
    for (number, sample) in samples.iter().enumerate() {
        green.at(unit.local(sample.world_point), &mut values, None);
        for (column, value) in values.iter().enumerate() {
            rows[(number, column)] = *value;
        }
    }
    rows
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
            Field::Linear(field) => field.frame(motions, displacements),
            Field::Conformal(conformal) => {
                conformal.frame(motions, displacements);
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
            Field::Linear(field) => field.jacobians(motions, out),
            Field::Conformal(conformal) => conformal.jacobians(motions, out),
        }
        true
    }

    fn solved_count(&self) -> usize {
        self.solved_count
    }
}
