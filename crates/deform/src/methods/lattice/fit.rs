//! The control points' displacements as the handles move: min Σ w |d(p) − target|² + λ |N D|², with N the identity or
//! second differences.

use faer::Mat;
use glam::USizeVec3;
use pliant_mesh::Cancel;

use super::LatticeNorm;
use super::grid::Grid;
use crate::BindError;
use crate::handles::Handle;
use crate::numerical::dense::solved;
use crate::space::affine::AffineParts;
use crate::space::fit_samples::Sample;

/// λ. The handles' constraints come first, and the norm decides the rest.
const REGULARISATION: f64 = 1e-8;

/// If second differences leave a choice, least displacements decide, with this factor.
const RIDGE: f64 = 1e-2;

/// The weight of a soft handle of weight 1: the lattice's resistance to half a wave of its own length.
pub(super) fn soft_unit(grid: &Grid, norm: LatticeNorm) -> f64 {
    let count = grid.count() as f64;
    let wave = match norm {
        LatticeNorm::Displacement => 1.0,
        LatticeNorm::Bending => (std::f64::consts::PI / count.cbrt()).powi(4),
    };
    0.5 * REGULARISATION * count * wave
}

/// Bytes of the fit.
pub(super) fn fit_bytes(grid: &Grid, handle_count: usize) -> u64 {
    let (count, columns) = (grid.count() as u64, 4 * handle_count as u64);
    // The matrix, the factorisation's scratch of one panel, and two copies of the right-hand sides.
    8 * count * (count + 2 * columns + 64)
}

/// Each control point's displacements: row-major, one entry per control point and handle.
pub(super) fn fitted(
    grid: &Grid,
    norm: LatticeNorm,
    samples: &[Sample],
    handles: &[Handle],
    affine: &AffineParts,
    cancel: &Cancel,
) -> Result<Vec<[f64; 4]>, BindError> {
    let count = grid.count();
    let mut matrix = Mat::<f64>::zeros(count, count);
    let mut right = Mat::<f64>::zeros(count, 4 * handles.len());
    let mut near: Vec<(usize, f64)> = Vec::new();
    for (number, sample) in samples.iter().enumerate() {
        if number % 1024 == 0 {
            cancel.check()?;
        }
        near.clear();
        grid.weights(sample.world_point, |control, weight, _| near.push((control, weight)));
        for &(row, a) in &near {
            for &(column, b) in &near {
                matrix[(row, column)] += sample.weight * a * b;
            }
        }
        for handle in 0..handles.len() {
            let base = affine.at(handle, sample.world_point);
            for k in 0..4 {
                let target = match sample.handle {
                    Some((own, coordinates)) if own == handle => coordinates[k],
                    _ => 0.0,
                };
                for &(row, weight) in &near {
                    right[(row, 4 * handle + k)] += sample.weight * weight * (target - base[k]);
                }
            }
        }
    }
    let mut square = |terms: &[(usize, f64)], factor: f64| {
        for &(row, a) in terms {
            for &(column, b) in terms {
                matrix[(row, column)] += REGULARISATION * factor * a * b;
            }
        }
    };
    for place in grid.places() {
        let own = grid.number(place);
        match norm {
            LatticeNorm::Displacement => square(&[(own, 1.0)], 1.0),
            LatticeNorm::Bending => {
                square(&[(own, 1.0)], RIDGE);
                second_differences(grid, place, &mut square);
            }
        }
    }
    cancel.check()?;
    let solution = solved(matrix, right);
    let controls = grid.places().flat_map(|place| {
        let (number, rest, solution) = (grid.number(place), grid.rest(place), &solution);
        (0..handles.len()).map(move |handle| {
            let base = affine.at(handle, rest);
            std::array::from_fn(|k| base[k] + solution[(number, 4 * handle + k)])
        })
    });
    Ok(controls.collect())
}

/// The squares of the second differences that begin at a place: along each axis, and twice the mixed ones.
fn second_differences(grid: &Grid, place: USizeVec3, square: &mut impl FnMut(&[(usize, f64)], f64)) {
    let counts = grid.counts();
    let number = |step: USizeVec3| {
        let place = place + step;
        place.cmplt(counts).all().then(|| grid.number(place))
    };
    let axes = USizeVec3::AXES;
    for (first, &a) in axes.iter().enumerate() {
        if let (Some(one), Some(two), Some(three)) = (number(USizeVec3::ZERO), number(a), number(2 * a)) {
            square(&[(one, 1.0), (two, -2.0), (three, 1.0)], 1.0);
        }
        for &b in &axes[first + 1..] {
            if let (Some(one), Some(two), Some(three), Some(four)) =
                (number(USizeVec3::ZERO), number(a), number(b), number(a + b))
            {
                square(&[(one, 1.0), (two, -1.0), (three, -1.0), (four, 1.0)], 2.0);
            }
        }
    }
}
