//! An animation of morph targets.

use glam::DVec3;
use rayon::prelude::*;

/// The number of vertices for one task.
const CHUNK: usize = 1 << 12;

/// An animation to be saved as morph targets: at each time the shape is that at rest and the sum of the targets by
/// their weights; between two times it is interpolated linearly.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct MorphAnimation<'a> {
    /// Its name; the file's targets have numbers after it.
    pub name: &'a str,
    /// In seconds, ascending.
    pub times: &'a [f64],
    /// For each time a weight for each target. As columns of a matrix the targets' weights are orthogonal, and none is
    /// zero.
    pub weights: &'a [Vec<f64>],
    /// For each target the displacement of each drawn vertex, in world space.
    pub targets: &'a [Vec<DVec3>],
    /// True if each time's shape holds until the next, without a way between them.
    pub holds: bool,
}

/// The golden ratio less 1: multiples of it are in no simple proportion.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The targets and weights in the file: some programs clamp weights to 0 to 1, so all weights are in that range.
///
/// A target whose weights have both signs is applied from its least weight on, and one more target, which is fully
/// applied at all times, has the shape that is left then.
pub(crate) struct Unsigned {
    /// For each time the weight of each target. f32 is the format's precision.
    pub weights: Vec<Vec<f32>>,
    /// Each target as a sum of the animation's own by these shares.
    pub shares: Vec<Vec<f64>>,
}

impl MorphAnimation<'_> {
    /// The names of the targets that the file gets.
    pub fn target_names(&self) -> Vec<String> {
        let count = self.unsigned().shares.len();
        (1..=count).map(|number| format!("{} {number}", self.name)).collect()
    }

    /// The targets and weights in the file.
    pub(crate) fn unsigned(&self) -> Unsigned {
        let count = self.targets.len();
        let column = |target: usize| self.weights.iter().map(move |row| row[target]);
        let ranges: Vec<(f64, f64)> = (0..count)
            .map(|target| column(target).fold((0.0, 0.0), |(low, high), weight| (weight.min(low), weight.max(high))))
            .collect();
        // If all weights of a target have one sign, the least one is 0.
        let from = |(low, high): (f64, f64)| if high > 0.0 { low } else { 0.0 };
        let length = |(low, high): (f64, f64)| if high > 0.0 { high - low } else { low };
        let mut weights: Vec<Vec<f32>> = self
            .weights
            .iter()
            .map(|row| {
                let parts = row.iter().zip(&ranges);
                parts
                    .map(|(weight, &range)| ((weight - from(range)) / length(range)) as f32)
                    .collect()
            })
            .collect();
        let mut shares: Vec<Vec<f64>> = vec![vec![0.0; count]; count];
        for (target, &range) in ranges.iter().enumerate() {
            shares[target][target] = length(range);
        }
        let left: Vec<f64> = ranges.iter().map(|&range| from(range)).collect();
        if left.iter().any(|&share| share != 0.0) {
            shares.push(left);
            weights.iter_mut().for_each(|row| row.push(1.0));
        }
        Unsigned { weights, shares }
    }

    /// The shape by these weights.
    pub(crate) fn shape(&self, rest: &[DVec3], weights: &[f64]) -> Vec<DVec3> {
        let mut shape = rest.to_vec();
        let chunks = shape.par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(chunk, shape)| {
            for (target, &weight) in self.targets.iter().zip(weights) {
                let ways = &target[chunk * CHUNK..];
                // Vertices that no target moves keep their bits.
                let moved = shape.iter_mut().zip(ways).filter(|(_, way)| **way != DVec3::ZERO);
                moved.for_each(|(position, way)| *position += *way * weight);
            }
        });
        shape
    }

    /// The shape with all targets, by weights in no simple proportion.
    pub(crate) fn mixed(&self, rest: &[DVec3]) -> Vec<DVec3> {
        let weights = (1..=self.targets.len()).map(|number| 0.5 + (number as f64 * GOLDEN).fract());
        self.shape(rest, &weights.collect::<Vec<f64>>())
    }

    /// The square length of each target's weights.
    pub(crate) fn column_sizes(&self) -> Vec<f64> {
        let column = |target: usize| self.weights.iter().map(|row| row[target] * row[target]).sum();
        (0..self.targets.len()).map(column).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_in_the_file_are_from_0_to_1_and_make_the_same_shapes() {
        let targets = [DVec3::X, DVec3::Y, DVec3::Z].map(|way| vec![way]);
        let weights: Vec<Vec<f64>> = [[0.0, -1.0, 0.25], [1.0, -0.5, -1.0], [0.5, 0.0, 1.0]]
            .map(Vec::from)
            .into();
        for (targets, more) in [(&targets[..2], 0), (&targets[..], 1)] {
            let weights: Vec<Vec<f64>> = weights.iter().map(|row| row[..targets.len()].to_vec()).collect();
            let animation = MorphAnimation {
                name: "a",
                times: &[0.0, 1.0, 2.0],
                weights: &weights,
                targets,
                holds: false,
            };
            let Unsigned {
                weights: stored,
                shares,
            } = animation.unsigned();
            assert_eq!(shares.len(), targets.len() + more);
            assert_eq!(animation.target_names().len(), shares.len());
            for (row, wanted) in stored.iter().zip(&weights) {
                assert!(row.iter().all(|weight| (0.0..=1.0).contains(weight)), "{row:?}");
                for (own, wanted) in wanted.iter().enumerate() {
                    let sum: f64 = row
                        .iter()
                        .zip(&shares)
                        .map(|(w, shares)| f64::from(*w) * shares[own])
                        .sum();
                    assert!((sum - wanted).abs() < 1e-6, "{row:?}: {sum} {wanted}");
                }
            }
        }
    }
}
