//! The control points' displacements as the handles move: min Σ w |d(p) − target|² + λ |N D|², with N the identity or
//! second differences.

use glam::{DVec3, USizeVec3};
use pliant_mesh::Cancel;

use super::LatticeNorm;
use super::grid::Grid;
use crate::BindError;
use crate::handles::Handle;
use crate::space::affine::AffineParts;
use crate::space::fit_samples::Sample;
use crate::space::point_fit::{Equations, by_rows, fitted_points};

/// The values of λ, the smallest first: with it the handles' constraints come first, and the norm decides the rest. With
/// more than the largest one a handle is missed so far that it hardly leads.
const REGULARISATIONS: [f64; 6] = [1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3];

/// If second differences leave a choice, least displacements decide, with this factor.
const RIDGE: f64 = 1e-2;

/// The weight of a soft handle of weight 1: the lattice's resistance to half a wave of its own length.
pub(super) fn soft_unit(grid: &Grid, norm: LatticeNorm) -> f64 {
    let count = grid.count() as f64;
    let wave = match norm {
        LatticeNorm::Displacement => 1.0,
        LatticeNorm::Bending => (std::f64::consts::PI / count.cbrt()).powi(4),
    };
    0.5 * REGULARISATIONS[0] * count * wave
}

/// Bytes of the fit.
pub(super) fn fit_bytes(grid: &Grid, handle_count: usize) -> u64 {
    let (count, columns) = (grid.count() as u64, 4 * handle_count as u64);
    // Three matrices, the factorisation's scratch of one panel, and five copies of the right-hand sides.
    8 * count * (3 * count + 5 * columns + 64)
}

/// Each control point's displacements: row-major, one entry per control point and handle. `soft` has each handle's weight
/// if it is soft.
pub(super) fn fitted(
    grid: &Grid,
    norm: LatticeNorm,
    samples: &[Sample],
    (handles, soft): (&[Handle], &[Option<f64>]),
    affine: &AffineParts,
    cancel: &Cancel,
) -> Result<Vec<[f64; 4]>, BindError> {
    let (count, columns) = (grid.count(), 4 * handles.len());
    let mut held = Equations::new(count, columns);
    // In units of λ: a soft handle yields to the lattice's resistance.
    let mut resisting = Equations::new(count, columns);
    let mut near: Vec<(usize, f64)> = Vec::new();
    let mut targets = vec![0.0; columns];
    for (number, sample) in samples.iter().enumerate() {
        if number % 1024 == 0 {
            cancel.check()?;
        }
        near.clear();
        grid.weights(sample.world_point, |control, weight, _| near.push((control, weight)));
        for (handle, targets) in targets.chunks_exact_mut(4).enumerate() {
            let base = affine.at(handle, sample.world_point);
            for k in 0..4 {
                let target = match sample.handle {
                    Some((own, coordinates)) if own == handle => coordinates[k],
                    _ => 0.0,
                };
                targets[k] = target - base[k];
            }
        }
        match sample.handle.and_then(|(own, _)| soft[own]) {
            Some(_) => resisting.add(&near, sample.weight / REGULARISATIONS[0], &targets),
            None => held.add(&near, sample.weight, &targets),
        }
    }
    for place in grid.places() {
        let own = grid.number(place);
        match norm {
            LatticeNorm::Displacement => resisting.add(&[(own, 1.0)], 1.0, &[]),
            LatticeNorm::Bending => {
                resisting.add(&[(own, 1.0)], RIDGE, &[]);
                second_differences(grid, place, &mut |terms, factor| resisting.add(terms, factor, &[]));
            }
        }
    }
    let world_rest: Vec<DVec3> = grid.places().map(|place| grid.rest(place)).collect();
    let equations = [&held, &resisting];
    let points = fitted_points(equations, &REGULARISATIONS, (handles, affine), &world_rest, cancel)?;
    Ok(by_rows(&points))
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
