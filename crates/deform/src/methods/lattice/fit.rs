//! The control points' displacements as the handles move: min Σ w |d(p) − target|² + λ |N D|², with N the identity or
//! second differences.
//!
//! The smaller λ is, the more closely the handles are met, but by swings of the control points that tear at everything
//! between and beyond the handles. So λ is the smallest one with which no point swings far.

use faer::Mat;
use glam::{DVec3, USizeVec3};
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

/// A control point moves at most so many times as far as the handles in a motion that they share. On the necks of a horse
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
        let sum = |own: &Mat<f64>, other: &Mat<f64>| {
            let entry = |row, column| own[(row, column)] + regularisation * other[(row, column)];
            Mat::from_fn(own.nrows(), own.ncols(), entry)
        };
        solved(sum(&self.matrix, &other.matrix), sum(&self.right, &other.right))
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

/// The largest way of a control point in a motion that all handles share: for a shift as a multiple of the shift; for a turn
/// or a stretch about their middle as a multiple of the point's own way in it, or at least of that of the handles.
///
/// Handles may also move against each other, as the sections of a curve do. Each of them alone then swings its
/// neighbours' points by far, and all together do not.
fn swing(grid: &Grid, handles: &[Handle], controls: &[[f64; 4]]) -> f64 {
    let count = handles.len().max(1);
    let middle = handles.iter().map(|handle| handle.world_centre).sum::<DVec3>() / count as f64;
    let reach = |handle: &Handle| handle.world_centre.distance(middle) + handle.radius;
    let radius = handles.iter().map(reach).fold(f64::MIN_POSITIVE, f64::max);
    let mut largest = 0.0_f64;
    for (place, ways) in grid.places().zip(controls.chunks_exact(count)) {
        let own = ((grid.rest(place) - middle) / radius).abs().max_element().max(1.0);
        let (mut linear, mut shift) = (DVec3::ZERO, 0.0);
        for (handle, way) in handles.iter().zip(ways) {
            let from_middle = (handle.world_centre - middle) / radius;
            linear += DVec3::new(way[0], way[1], way[2]) * (handle.radius / radius) + from_middle * way[3];
            shift += way[3];
        }
        largest = largest.max(shift.abs()).max(linear.abs().max_element() / own);
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
