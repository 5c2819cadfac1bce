//! Centres, chosen greedily [BK05]: first a few that are far from each other, then the constraints with the largest
//! errors of the field, until no error exceeds the tolerance.

use glam::DVec3;
use pliant_mesh::Cancel;
use rayon::prelude::*;

use super::Rbf;
use super::constraints::Constraint;
use super::kernel::{Sum, Weights};
use super::system::weights;
use crate::BindError;

/// The initial number of centres.
const FIRST: usize = 16;

/// Each round adds this share of the present centres.
const ROUND: f64 = 0.5;

/// Constraints that are nearer to each other, in the unit of all, can't both be centres: the system
/// would be singular.
const APART: f64 = 1e-6;

/// The number of points that one task evaluates.
const CHUNK: usize = 512;

/// A field, and its largest error at the constraints, as a share of the handles' displacement.
pub(super) struct Fitted {
    pub weights: Weights,
    pub error: f64,
}

/// Chooses the centres and solves for their weights.
///
/// # Errors
/// It was cancelled.
pub(super) fn fitted(
    options: &Rbf,
    constraints: &[Constraint],
    handle_count: usize,
    cancel: &Cancel,
) -> Result<Fitted, BindError> {
    let most = options.centres as usize;
    let mut chooser = Chooser::new(constraints);
    for _ in 0..FIRST.min(most) {
        // A constraint far from all centres counts, whatever the field's error.
        chooser.choose(&vec![1.0; constraints.len()]);
    }
    loop {
        cancel.check()?;
        let weights = weights(&chooser.centres(), handle_count);
        let misses = misses(&weights, constraints, cancel)?;
        let error = chooser.open(&misses).fold(0.0, f64::max);
        let count = chooser.chosen.len();
        let more = ((count as f64 * ROUND) as usize).max(1).min(most - count);
        if error <= options.tolerance || more == 0 {
            return Ok(Fitted { weights, error });
        }
        for _ in 0..more {
            if !chooser.choose_above(&misses, options.tolerance) {
                break;
            }
        }
        if chooser.chosen.len() == count {
            return Ok(Fitted { weights, error });
        }
    }
}

/// A field's error at each constraint: the largest error of its handles' columns.
fn misses(weights: &Weights, constraints: &[Constraint], cancel: &Cancel) -> Result<Vec<f64>, BindError> {
    let mut misses = vec![0.0; constraints.len()];
    constraints
        .par_chunks(CHUNK)
        .zip(misses.par_chunks_mut(CHUNK))
        .try_for_each(|(constraints, misses)| {
            cancel.check()?;
            let points: Vec<DVec3> = constraints.iter().map(|constraint| constraint.point).collect();
            let mut sums = vec![Sum::default(); points.len()];
            for handle in 0..weights.handle_count {
                weights.evaluate(handle, &points, &mut sums);
                for ((miss, sum), constraint) in misses.iter_mut().zip(&sums).zip(constraints) {
                    let expected = match constraint.handle {
                        Some((own, coordinates)) if own == handle => coordinates,
                        _ => [0.0; 4],
                    };
                    let off = (0..4).map(|k| (sum[0][k] - expected[k]).abs());
                    // NaN counts as the largest error.
                    *miss = off.fold(
                        *miss,
                        |worst: f64, off| if off.is_nan() { f64::INFINITY } else { worst.max(off) },
                    );
                }
            }
            Ok::<_, BindError>(())
        })?;
    Ok(misses)
}

/// The constraints that became centres, and each one's distance to the nearest centre.
struct Chooser<'a> {
    constraints: &'a [Constraint],
    chosen: Vec<usize>,
    distances: Vec<f64>,
}

impl<'a> Chooser<'a> {
    fn new(constraints: &'a [Constraint]) -> Self {
        Self {
            constraints,
            chosen: Vec::new(),
            distances: vec![f64::INFINITY; constraints.len()],
        }
    }

    fn centres(&self) -> Vec<Constraint> {
        self.chosen.iter().map(|&number| self.constraints[number]).collect()
    }

    /// The entries of the constraints that may still become centres.
    fn open(&self, values: &[f64]) -> impl Iterator<Item = f64> {
        let pairs = values.iter().zip(&self.distances);
        pairs
            .filter(|(_, distance)| **distance > APART)
            .map(|(value, _)| *value)
    }

    /// Chooses the constraint with the largest product of this number and the distance to the nearest centre.
    fn choose(&mut self, values: &[f64]) -> bool {
        self.choose_above(values, 0.0)
    }

    /// Like [`Chooser::choose`], among the constraints with a number above `least`. The distance keeps the centres of a
    /// round apart, since each of them corrects its surroundings.
    fn choose_above(&mut self, values: &[f64], least: f64) -> bool {
        let candidates =
            (0..self.constraints.len()).filter(|&number| self.distances[number] > APART && values[number] > least);
        let score = |number: usize| values[number] * self.distances[number].min(2.0);
        // The first of equal ones.
        let best = candidates.reduce(|best, other| if score(other) > score(best) { other } else { best });
        let Some(best) = best else { return false };
        self.chosen.push(best);
        let point = self.constraints[best].point;
        self.distances
            .par_iter_mut()
            .zip(self.constraints)
            .with_min_len(4096)
            .for_each(|(distance, other)| *distance = distance.min(other.point.distance(point)));
        true
    }
}
