//! The fit by which the handles drive the cage: min Σ w |d(p) − target|² + λ |L D|² over the displacements D of the
//! cage's vertices, with L the difference from the mean of the neighbours. So the cage bends smoothly between the
//! handles.
//!
//! As for a lattice, λ is the smallest one with which no vertex swings far ([`fitted_points`]).

use faer::Mat;
use glam::DVec3;
use pliant_mesh::Cancel;

use super::mesh::CageMesh;
use crate::BindError;
use crate::handles::Handle;
use crate::space::affine::AffineParts;
use crate::space::fit_samples::Sample;
use crate::space::point_fit::{Equations, fitted_points};

/// The values of λ, the smallest first: with it the handles' constraints come first. With more than the largest one a
/// handle is missed so far that it hardly leads.
const REGULARISATIONS: [f64; 6] = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1];

/// Where these differences leave a choice, least displacements decide, with this factor.
pub(super) const RIDGE: f64 = 1e-3;

/// The weight of a soft handle of weight 1: about the resistance of the cage.
pub(super) fn soft_unit(cage: &CageMesh) -> f64 {
    REGULARISATIONS[0] * cage.vertices.len() as f64 * 0.1
}

/// The bytes of the fit.
pub(super) fn fit_bytes(vertex_count: usize, sample_count: usize) -> u64 {
    let (vertices, samples) = (vertex_count as u64, sample_count as u64);
    8 * vertices * (3 * vertices + 4 * samples + 64)
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
/// each handle. `rows` has the coordinates, one row for each sample; `world_vertices` are the vertices' rest positions.
///
/// # Errors
/// If it was cancelled.
pub(super) fn controls(
    cage: &CageMesh,
    rows: &Mat<f64>,
    samples: &[Sample],
    (handles, soft): (&[Handle], &[Option<f64>]),
    affine: &AffineParts,
    world_vertices: &[DVec3],
    cancel: &Cancel,
) -> Result<Mat<f64>, BindError> {
    let misses = Mat::from_fn(samples.len(), 4 * handles.len(), |sample, column| {
        let (handle, k) = (column / 4, column % 4);
        let target = match samples[sample].handle {
            Some((own, coordinates)) if own == handle => coordinates[k],
            _ => 0.0,
        };
        target - affine.at(handle, samples[sample].world_point)[k]
    });
    let is_soft = |sample: &Sample| sample.handle.is_some_and(|(own, _)| soft[own].is_some());
    let held = Equations::of(rows, &misses, |sample| match is_soft(&samples[sample]) {
        true => 0.0,
        false => samples[sample].weight,
    });
    // In units of λ: a soft handle yields to the cage's resistance.
    let mut resisting = match soft.iter().any(Option::is_some) {
        true => Equations::of(rows, &misses, |sample| match is_soft(&samples[sample]) {
            true => samples[sample].weight / REGULARISATIONS[0],
            false => 0.0,
        }),
        false => Equations::new(rows.ncols(), misses.ncols()),
    };
    add_differences(&mut resisting.matrix, cage, 1.0);
    let equations = [&held, &resisting];
    fitted_points(equations, &REGULARISATIONS, (handles, affine), world_vertices, cancel)
}
