//! The least-squares fit of control points to handles: min Σ w |d(p) − target|² + λ R over the points' displacements, with
//! R the resistance of the lattice or cage.
//!
//! The smaller λ is, the more closely the handles are met, but by swings of the control points that tear at everything
//! between and beyond the handles. So λ is the smallest one with which no point swings far.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use glam::DVec3;
use pliant_mesh::Cancel;

use super::affine::AffineParts;
use crate::BindError;
use crate::handles::Handle;
use crate::numerical::dense::solved;

/// A control point moves at most so many times as far as the handles in a motion that they share. With a lattice on the
/// necks of a horse and an armadillo, moved by a patch below a free head, the head keeps its shape up to 2.5 and is torn
/// at 2.8.
const SWING: f64 = 2.5;

/// Normal equations, A x = b.
pub(crate) struct Equations {
    pub(crate) matrix: Mat<f64>,
    pub(crate) right: Mat<f64>,
}

impl Equations {
    /// None of them.
    pub(crate) fn new(count: usize, columns: usize) -> Self {
        Self {
            matrix: Mat::zeros(count, count),
            right: Mat::zeros(count, columns),
        }
    }

    /// Those of Σ w (r x − target)² over rows r with their targets and weights.
    pub(crate) fn of(rows: &Mat<f64>, targets: &Mat<f64>, weight: impl Fn(usize) -> f64) -> Self {
        let (row_count, count) = (rows.nrows(), rows.ncols());
        let weighted = Mat::from_fn(count, row_count, |point, row| rows[(row, point)] * weight(row));
        let mut own = Self::new(count, targets.ncols());
        multiply(&mut own.matrix, &weighted, rows);
        multiply(&mut own.right, &weighted, targets);
        own
    }

    /// Adds `factor` (Σ a x)² for these terms (row, a), whose target in each column is given.
    pub(crate) fn add(&mut self, terms: &[(usize, f64)], factor: f64, targets: &[f64]) {
        for &(row, a) in terms {
            for &(column, b) in terms {
                self.matrix[(row, column)] += factor * a * b;
            }
            for (column, target) in targets.iter().enumerate() {
                self.right[(row, column)] += factor * a * target;
            }
        }
    }

    /// The solution of these equations and λ times the others.
    fn solved_with(&self, other: &Self, regularisation: f64) -> Mat<f64> {
        let sum = |own: &Mat<f64>, other: &Mat<f64>| {
            let entry = |row, column| own[(row, column)] + regularisation * other[(row, column)];
            Mat::from_fn(own.nrows(), own.ncols(), entry)
        };
        solved(sum(&self.matrix, &other.matrix), sum(&self.right, &other.right))
    }
}

/// The displacements of control points that are linear in the handles' motions: one row for each point and four columns
/// for each handle. `held` are the equations of the fit, less the handles' affine parts, and `resisting` those of R; λ is
/// one of `regularisations`, which ascend.
///
/// # Errors
/// If it was cancelled.
pub(crate) fn fitted_points(
    [held, resisting]: [&Equations; 2],
    regularisations: &[f64],
    (handles, affine): (&[Handle], &AffineParts),
    world_rest: &[DVec3],
    cancel: &Cancel,
) -> Result<Mat<f64>, BindError> {
    let mut points = Mat::zeros(world_rest.len(), held.right.ncols());
    for regularisation in regularisations {
        cancel.check()?;
        let solution = held.solved_with(resisting, *regularisation);
        points = Mat::from_fn(world_rest.len(), solution.ncols(), |point, column| {
            affine.at(column / 4, world_rest[point])[column % 4] + solution[(point, column)]
        });
        if swing(world_rest, handles, &points) <= SWING {
            break;
        }
    }
    Ok(points)
}

/// The same as one entry for each point and handle, row-major.
pub(crate) fn by_rows(points: &Mat<f64>) -> Vec<[f64; 4]> {
    let row = |point: usize| {
        let handles = 0..points.ncols() / 4;
        handles.map(move |handle| [0, 1, 2, 3].map(|k| points[(point, 4 * handle + k)]))
    };
    (0..points.nrows()).flat_map(row).collect()
}

/// The largest way of a control point in a motion that all handles share: for a shift as a multiple of the shift; for a turn
/// or a stretch about their middle as a multiple of the point's own way in it, or at least of that of the handles.
///
/// Handles may also move against each other, as the sections of a curve do. Each of them alone then swings its
/// neighbours' points by far, and all together do not.
fn swing(world_rest: &[DVec3], handles: &[Handle], points: &Mat<f64>) -> f64 {
    let count = handles.len().max(1);
    let middle = handles.iter().map(|handle| handle.world_centre).sum::<DVec3>() / count as f64;
    let reach = |handle: &Handle| handle.world_centre.distance(middle) + handle.radius;
    let radius = handles.iter().map(reach).fold(f64::MIN_POSITIVE, f64::max);
    let mut largest = 0.0_f64;
    for (point, rest) in world_rest.iter().enumerate() {
        let own = ((*rest - middle) / radius).abs().max_element().max(1.0);
        let (mut linear, mut shift) = (DVec3::ZERO, 0.0);
        for (number, handle) in handles.iter().enumerate() {
            let way = |k: usize| points[(point, 4 * number + k)];
            let from_middle = (handle.world_centre - middle) / radius;
            linear += DVec3::new(way(0), way(1), way(2)) * (handle.radius / radius) + from_middle * way(3);
            shift += way(3);
        }
        largest = largest.max(shift.abs()).max(linear.abs().max_element() / own);
    }
    largest
}

/// Multiplies on one thread, so that the bits do not depend on the number of threads.
fn multiply(out: &mut Mat<f64>, a: &Mat<f64>, b: &Mat<f64>) {
    matmul(out.as_mut(), Accum::Replace, a.as_ref(), b.as_ref(), 1.0, Par::Seq);
}
