//! The fit by which the handles drive the cage: min Σ w |d(p) − target|² + λ |L D|² over the displacements D of the
//! cage's vertices, with L the difference from the mean of the neighbours. So the cage bends smoothly between the
//! handles.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use glam::DVec3;

use super::mesh::CageMesh;
use crate::handles::Handle;
use crate::numerical::dense::solved;
use crate::space::affine::AffineParts;
use crate::space::fit_samples::Sample;

/// λ.
const REGULARISATION: f64 = 1e-6;

/// Where these differences leave a choice, least displacements decide, with this factor.
pub(super) const RIDGE: f64 = 1e-3;

/// The weight of a soft handle of weight 1: about the resistance of the cage.
pub(super) fn soft_unit(cage: &CageMesh) -> f64 {
    REGULARISATION * cage.vertices.len() as f64 * 0.1
}

/// The bytes of the fit.
pub(super) fn fit_bytes(vertex_count: usize, sample_count: usize) -> u64 {
    let (vertices, samples) = (vertex_count as u64, sample_count as u64);
    8 * vertices * (2 * vertices + 4 * samples + 64)
}

/// The normal equations: their matrix, and the factor of the samples' errors, one row for each vertex and one column
/// for each sample. `rows` has the coordinates, one row for each sample.
fn normal_equations(cage: &CageMesh, rows: &Mat<f64>, samples: &[Sample]) -> (Mat<f64>, Mat<f64>) {
    let (count, sample_count) = (cage.vertices.len(), samples.len());
    let weighted = Mat::from_fn(count, sample_count, |vertex, sample| {
        rows[(sample, vertex)] * samples[sample].weight
    });
    let mut matrix = Mat::<f64>::zeros(count, count);
    multiply(&mut matrix, &weighted, rows);
    add_differences(&mut matrix, cage, REGULARISATION);
    (matrix, weighted)
}

/// Adds `factor` (Lᵀ L + ε).
pub(super) fn add_differences(matrix: &mut Mat<f64>, cage: &CageMesh, factor: f64) {
    for (vertex, neighbours) in cage.neighbours().iter().enumerate() {
        let share = -1.0 / neighbours.len() as f64;
        let own = neighbours.iter().map(|&other| (other as usize, share));
        let terms: Vec<(usize, f64)> = own.chain([(vertex, 1.0)]).collect();
        for &(row, a) in &terms {
            for &(column, b) in &terms {
                matrix[(row, column)] += factor * a * b;
            }
        }
        matrix[(vertex, vertex)] += factor * RIDGE;
    }
}

/// The vertices' displacements that are linear in the handles' motions: one row for each vertex and four columns for
/// each handle. `world_vertices` are their rest positions.
pub(super) fn controls(
    cage: &CageMesh,
    rows: &Mat<f64>,
    samples: &[Sample],
    handles: &[Handle],
    affine: &AffineParts,
    world_vertices: &[DVec3],
) -> Mat<f64> {
    let misses = Mat::from_fn(samples.len(), 4 * handles.len(), |sample, column| {
        let (handle, k) = (column / 4, column % 4);
        let target = match samples[sample].handle {
            Some((own, coordinates)) if own == handle => coordinates[k],
            _ => 0.0,
        };
        target - affine.at(handle, samples[sample].world_point)[k]
    });
    let (matrix, weighted) = normal_equations(cage, rows, samples);
    let mut right = Mat::zeros(cage.vertices.len(), misses.ncols());
    multiply(&mut right, &weighted, &misses);
    let solution = solved(matrix, right);
    Mat::from_fn(world_vertices.len(), misses.ncols(), |vertex, column| {
        solution[(vertex, column)] + affine.at(column / 4, world_vertices[vertex])[column % 4]
    })
}

/// Multiplies on one thread, so that the bits do not depend on the number of threads.
fn multiply(out: &mut Mat<f64>, a: &Mat<f64>, b: &Mat<f64>) {
    matmul(out.as_mut(), Accum::Replace, a.as_ref(), b.as_ref(), 1.0, Par::Seq);
}
