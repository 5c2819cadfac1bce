//! The energy that fits a cage of Green coordinates: min over the displacements D of its vertices of
//!
//! E = Σ w |d(p) − target|² + λ (|L (D − B)|² + ε |D − B|²) + σ Σ_f A_f (q_f − 1/q_f)²,
//!
//! with L the difference from the mean of the neighbours and B the displacements of the vertices without the handles,
//! as in `fit` for coordinates that are linear in the vertices. Here d is not linear: the faces' stretched normals
//! follow the vertices, too. The last term keeps the angles of the cage's faces f ([`RestFace::shear`]; A_f is a face's
//! share of the area): a face that collapses would have no normal, and steps end where one does. The falloff also holds
//! fixed points, so a fixed sample counts less than the handles.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use glam::DVec3;

use super::fit::{RIDGE, add_differences};
use super::lane_rows::LaneRows;
use super::moved_cage::{MovedCage, RestCage};
use super::stretched::Slopes;
use crate::BindError;
use crate::numerical::dense::Lu;
use crate::space::fit_samples::Sample;

/// The share of its weight that a fixed sample has.
const FIXED: f64 = 0.03;

/// λ. With three times as much, the cage misses handles on a sphere by more than twice as much as with mean value
/// coordinates.
const RESISTANCE: f64 = 3e-7;

/// σ.
const SHEAR: f64 = 3e-6;

/// The bound form.
#[derive(Debug)]
pub(super) struct GreenFit {
    pub cage: RestCage,
    points: Vec<DVec3>,
    weights: Vec<f64>,
    /// The samples' coordinates, one row for each sample, and the same transposed.
    rows: LaneRows<f64>,
    columns: LaneRows<f64>,
    neighbours: Vec<Vec<u32>>,
    /// σ times the faces' shares of the area.
    shear_weights: Vec<f64>,
    preconditioner: Lu,
}

/// The targets for the cage.
#[derive(Debug)]
pub(super) struct Asked {
    /// The samples' displacements.
    pub targets: Vec<DVec3>,
    /// B.
    pub base: Vec<DVec3>,
}

/// The cage with one choice of its vertices' displacements.
#[derive(Debug)]
pub(super) struct Tried {
    pub shifts: Vec<DVec3>,
    pub moved: MovedCage,
    /// The samples' displacements less their targets.
    misses: Vec<DVec3>,
    /// D − B.
    strays: Vec<DVec3>,
    /// E.
    pub energy: f64,
}

/// The derivatives of everything in E by the vertices: J, the derivative of d, and the derivative of each face's q −
/// 1/q.
#[derive(Debug)]
pub(super) struct Derivatives {
    normals: Vec<Slopes>,
    shears: Vec<(f64, [DVec3; 3])>,
}

impl GreenFit {
    /// Binds the fit for samples at these points with these coordinates, one row for each sample.
    ///
    /// # Errors
    /// It fails if there is no memory.
    pub fn bind(cage: RestCage, points: Vec<DVec3>, samples: &[Sample], rows: &Mat<f64>) -> Result<Self, BindError> {
        let (sample_count, count) = (rows.nrows(), rows.ncols());
        let out_of_memory = |_| BindError::OutOfMemory {
            free_count: sample_count,
        };
        let weight = |sample: &Sample| sample.weight * if sample.handle.is_some() { 1.0 } else { FIXED };
        let weights: Vec<f64> = samples.iter().map(weight).collect();
        let of_columns = LaneRows::of(count, sample_count, |column, sample| rows[(sample, column)]);
        let of_rows = LaneRows::of(sample_count, count, |sample, column| rows[(sample, column)]);
        let area: f64 = cage.faces.iter().map(|face| face.area()).sum();
        let shear_weights = cage.faces.iter().map(|face| SHEAR * face.area() / area).collect();
        Ok(Self {
            neighbours: cage.mesh.neighbours(),
            preconditioner: Lu::of(mean_equations(&cage, rows, &weights)),
            points,
            weights,
            rows: of_rows.map_err(out_of_memory)?,
            columns: of_columns.map_err(out_of_memory)?,
            shear_weights,
            cage,
        })
    }

    /// The multiplications of a step's product with a direction, and of its preconditioner.
    pub fn work(&self) -> usize {
        let vertices = self.neighbours.len();
        let columns = vertices + self.shear_weights.len();
        6 * self.points.len() * columns + 3 * vertices * vertices
    }

    /// The field of a moved cage at the samples.
    pub fn at_samples(&self, moved: &MovedCage) -> Vec<DVec3> {
        moved.at(&self.points, &self.rows)
    }

    /// The cage with these displacements.
    pub fn tried(&self, asked: &Asked, shifts: Vec<DVec3>) -> Tried {
        let moved = self.cage.moved(&shifts);
        let mut misses = self.at_samples(&moved);
        for (miss, target) in misses.iter_mut().zip(&asked.targets) {
            *miss = *target - *miss;
        }
        let strays = shifts.iter().zip(&asked.base).map(|(own, base)| *own - *base);
        let strays: Vec<DVec3> = strays.collect();
        let squares = misses.iter().zip(&self.weights);
        let missed: f64 = squares.map(|(miss, weight)| miss.length_squared() * weight).sum();
        let places = self.cage.places(&shifts);
        let shears = self.cage.faces.iter().zip(&self.shear_weights);
        let sheared: f64 = shears
            .map(|(face, weight)| face.shear(&places).0.powi(2) * weight)
            .sum();
        Tried {
            energy: missed + dot(&strays, &self.resistance(&strays)) + sheared,
            shifts,
            moved,
            misses,
            strays,
        }
    }

    /// The derivatives at these displacements.
    pub fn derivatives(&self, at: &Tried) -> Derivatives {
        let places = self.cage.places(&at.shifts);
        let faces = &self.cage.faces;
        Derivatives {
            normals: faces.iter().map(|face| face.slopes(&places)).collect(),
            shears: faces.iter().map(|face| face.shear(&places)).collect(),
        }
    }

    /// −½ ∇E.
    pub fn downhill(&self, derivatives: &Derivatives, at: &Tried) -> Vec<DVec3> {
        let mut out = self.pulled(derivatives, &at.misses);
        add(&mut out, -1.0, &self.resistance(&at.strays));
        let faces = self.cage.mesh.faces.iter().zip(&derivatives.shears);
        for ((face, (shear, by_corners)), weight) in faces.zip(&self.shear_weights) {
            for (&corner, slope) in face.iter().zip(by_corners) {
                out[corner as usize] -= *slope * (weight * shear);
            }
        }
        out
    }

    /// The Gauss–Newton matrix of ½ E times displacements, with `damping` times the resistance added to it.
    pub fn product(&self, derivatives: &Derivatives, damping: f64, shifts: &[DVec3]) -> Vec<DVec3> {
        let mut out = self.pulled(derivatives, &self.followed(derivatives, shifts));
        add(&mut out, 1.0 + damping, &self.resistance(shifts));
        let faces = self.cage.mesh.faces.iter().zip(&derivatives.shears);
        for ((face, (_, by_corners)), weight) in faces.zip(&self.shear_weights) {
            let along = face.iter().zip(by_corners);
            let along: f64 = along.map(|(&corner, slope)| slope.dot(shifts[corner as usize])).sum();
            for (&corner, slope) in face.iter().zip(by_corners) {
                out[corner as usize] += *slope * (weight * along);
            }
        }
        out
    }

    /// Approximately solves [`Self::product`]: with the mean over the axes of the equations at rest. No turn of the
    /// whole cage changes it.
    pub fn preconditioned(&self, field: &[DVec3]) -> Vec<DVec3> {
        let solved = self
            .preconditioner
            .solved(Mat::from_fn(field.len(), 3, |row, axis| field[row][axis]));
        let row = |row: usize| DVec3::from_array([0, 1, 2].map(|axis| solved[(row, axis)]));
        (0..field.len()).map(row).collect()
    }

    /// λ (Lᵀ L + ε) times displacements.
    fn resistance(&self, shifts: &[DVec3]) -> Vec<DVec3> {
        let mut out: Vec<DVec3> = shifts.iter().map(|shift| *shift * (RESISTANCE * RIDGE)).collect();
        for (vertex, own) in self.neighbours.iter().enumerate() {
            let share = 1.0 / own.len() as f64;
            let mean = own.iter().map(|&other| shifts[other as usize]).sum::<DVec3>() * share;
            let bend = (shifts[vertex] - mean) * RESISTANCE;
            out[vertex] += bend;
            for &other in own {
                out[other as usize] -= bend * share;
            }
        }
        out
    }

    /// Jᵀ W times displacements of the samples.
    fn pulled(&self, derivatives: &Derivatives, misses: &[DVec3]) -> Vec<DVec3> {
        let weighted = misses.iter().zip(&self.weights).map(|(miss, weight)| *miss * *weight);
        let mut out = self.columns.product(&weighted.collect::<Vec<_>>());
        let of_faces = out.split_off(self.neighbours.len());
        for ((face, slopes), pull) in self.cage.mesh.faces.iter().zip(&derivatives.normals).zip(of_faces) {
            for (&corner, slope) in face.iter().zip(slopes.by_corners()) {
                out[corner as usize] += slope.transpose() * pull;
            }
        }
        out
    }

    /// J times displacements of the vertices.
    fn followed(&self, derivatives: &Derivatives, shifts: &[DVec3]) -> Vec<DVec3> {
        let faces = self.cage.mesh.faces.iter().zip(&derivatives.normals);
        let of_faces = faces.map(|(face, slopes)| {
            let corners = face.iter().zip(slopes.by_corners());
            corners.map(|(&corner, slope)| slope * shifts[corner as usize]).sum()
        });
        let terms: Vec<DVec3> = shifts.iter().copied().chain(of_faces).collect();
        self.rows.product(&terms)
    }
}

/// The bytes of the fit for this many vertices, faces and samples.
pub(super) fn green_fit_bytes(vertex_count: usize, face_count: usize, sample_count: usize) -> u64 {
    let (vertices, faces, samples) = (vertex_count as u64, face_count as u64, sample_count as u64);
    8 * (2 * vertices * vertices + 3 * samples * (vertices + faces) + 2 * samples * vertices + 40 * faces)
}

/// Σ_k (Jᵀ W J)_kk / 3 + λ (Lᵀ L + ε) over the axes k, at rest.
fn mean_equations(cage: &RestCage, rows: &Mat<f64>, weights: &[f64]) -> Mat<f64> {
    let (sample_count, count) = (rows.nrows(), cage.mesh.vertices.len());
    let rest = &cage.mesh.vertices;
    let slopes: Vec<_> = cage.faces.iter().map(|face| face.slopes(rest).by_corners()).collect();
    let mut matrix = Mat::<f64>::zeros(count, count);
    add_differences(&mut matrix, &cage.mesh, RESISTANCE);
    for (row, column) in (0..9).map(|entry| (entry / 3, entry % 3)) {
        let mut own = match row == column {
            true => Mat::from_fn(sample_count, count, |sample, vertex| rows[(sample, vertex)]),
            false => Mat::zeros(sample_count, count),
        };
        for (number, (face, slopes)) in cage.mesh.faces.iter().zip(&slopes).enumerate() {
            for (&corner, slope) in face.iter().zip(slopes) {
                let slope = slope.col(column)[row];
                for sample in 0..sample_count {
                    own[(sample, corner as usize)] += rows[(sample, count + number)] * slope;
                }
            }
        }
        let weighted = Mat::from_fn(count, sample_count, |vertex, sample| {
            own[(sample, vertex)] * weights[sample] / 3.0
        });
        // One thread multiplies, so that the bits do not depend on the number of threads.
        matmul(
            matrix.as_mut(),
            Accum::Add,
            weighted.as_ref(),
            own.as_ref(),
            1.0,
            Par::Seq,
        );
    }
    matrix
}

/// a · b.
pub(super) fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

/// a ← a + factor b.
pub(super) fn add(a: &mut [DVec3], factor: f64, b: &[DVec3]) {
    for (a, b) in a.iter_mut().zip(b) {
        *a += *b * factor;
    }
}
