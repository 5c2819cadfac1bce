//! An animation of morph targets.

use glam::DVec3;
use rayon::prelude::*;

/// The number of vertices for one task.
const CHUNK: usize = 1 << 12;

/// An animation to be saved as morph targets: at each time the shape is that at rest and the sum of the targets by
/// their weights; between two times it is interpolated linearly.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct MorphAnimation<'a> {
    /// Its name.
    pub name: &'a str,
    /// The name of each target.
    pub names: &'a [String],
    /// In seconds, ascending.
    pub times: &'a [f64],
    /// For each time a weight for each target. As columns of a matrix the targets' weights are orthogonal, and none is
    /// zero.
    pub weights: &'a [Vec<f64>],
    /// For each target the displacement of each drawn vertex, in world space.
    pub targets: &'a [Vec<DVec3>],
}

/// The golden ratio less 1: multiples of it are in no simple proportion.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

impl MorphAnimation<'_> {
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
