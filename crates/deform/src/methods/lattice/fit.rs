//! The control points' displacements as the handles move: min Σ w |d(p) − target|² + λ |N D|², with N the identity or
//! second differences.
//!
//! The smaller λ is, the more closely the handles are met, but by swings of the control points that tear at everything
//! between and beyond the handles. So λ is the smallest one with which no point swings far.

use faer::{Mat, Scale};
use glam::USizeVec3;
use pliant_mesh::Cancel;

use super::LatticeNorm;
use super::grid::Grid;
use crate::BindError;
use crate::handles::Handle;
use crate::numerical::dense::solved;
use crate::space::affine::AffineParts;
use crate::space::fit_samples::Sample;

/// The values of λ, the smallest first: with it the handles' constraints come first, and the norm decides the rest. With
/// more than the largest one a handle is missed so far that it hardly leads.
const REGULARISATIONS: [f64; 6] = [1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3];

/// A control point moves at most so many times as far as it would with its handle's own motion. On the necks of a horse
/// and an armadillo, moved by a patch below a free head, the head keeps its shape up to 2.5 and is torn at 2.8.
const SWING: f64 = 2.5;

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

/// The normal equations of the fit, A x = b.
struct Equations {
    matrix: Mat<f64>,
    right: Mat<f64>,
}

impl Equations {
    fn new(count: usize, columns: usize) -> Self {
        Self {
            matrix: Mat::zeros(count, count),
            right: Mat::zeros(count, columns),
        }
    }

    /// Adds `factor` (Σ a x)² for these terms (row, a), whose target in each column is given.
    fn add(&mut self, terms: &[(usize, f64)], factor: f64, targets: &[f64]) {
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
        let scale = Scale(regularisation);
        solved(&self.matrix + scale * &other.matrix, &self.right + scale * &other.right)
    }
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
    let mut controls = Vec::new();
    for regularisation in REGULARISATIONS {
        cancel.check()?;
        let solution = held.solved_with(&resisting, regularisation);
        controls.clear();
        for place in grid.places() {
            let (number, rest) = (grid.number(place), grid.rest(place));
            controls.extend((0..handles.len()).map(|handle| -> [f64; 4] {
                let base = affine.at(handle, rest);
                std::array::from_fn(|k| base[k] + solution[(number, 4 * handle + k)])
            }));
        }
        if swing(grid, handles, &controls) <= SWING {
            break;
        }
    }
    Ok(controls)
}

/// The largest way of a control point: for a shift of its handle as a multiple of the shift; for a turn or a stretch as a
/// multiple of the point's way with the handle's own motion, or at least of that of the handle's vertices.
fn swing(grid: &Grid, handles: &[Handle], controls: &[[f64; 4]]) -> f64 {
    let mut largest = 0.0_f64;
    for (place, ways) in grid.places().zip(controls.chunks_exact(handles.len().max(1))) {
        let rest = grid.rest(place);
        for (handle, [linear @ .., shift]) in handles.iter().zip(ways) {
            let [own @ .., _] = handle.coordinates(rest);
            let own = own.into_iter().fold(1.0, |most: f64, value| most.max(value.abs()));
            largest = linear
                .iter()
                .fold(largest.max(shift.abs()), |largest, way| largest.max(way.abs() / own));
        }
    }
    largest
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
