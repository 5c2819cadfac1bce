//! The affine map that fits the samples best if nothing is fixed. Methods whose own field resists motion solve for it
//! first, so that an affine motion of the whole is exact. If something is fixed the map would move places far from the
//! handles, so there is none.

use faer::Mat;
use glam::DVec3;

use super::fit_samples::Sample;
use crate::handles::Handle;
use crate::numerical::dense::solved;

/// The weight of the linear parts of the handles' motions relative to the displacements of their samples. They decide
/// if the samples are in a plane, on a line or in one point.
const LINEAR_PART: f64 = 0.01;

/// An affine map per handle and column: a(p) = constant + slope · (p − origin).
#[derive(Clone, Debug)]
pub(crate) struct AffineParts {
    world_origin: DVec3,
    /// For each handle the constants and the slopes of its four columns.
    parts: Vec<([f64; 4], [DVec3; 4])>,
}

impl AffineParts {
    /// For each handle h and column k the affine function a that minimises Σ w (a(p) − b(p))² + ε Σ w u² |∇a − ∇b|²,
    /// where b is the handle's coordinate k at its own samples and 0 at all others, and u is `world_unit`, about the
    /// size of the region. If all handles have the same affine motion, the sum over the handles is that motion. It is
    /// zero if a sample is fixed.
    pub fn fitted(samples: &[Sample], handles: &[Handle], world_origin: DVec3, world_unit: f64) -> Self {
        if samples.iter().any(|sample| sample.handle.is_none()) {
            return Self {
                world_origin,
                parts: vec![Default::default(); handles.len()],
            };
        }
        let mut matrix = Mat::<f64>::zeros(4, 4);
        let mut right = Mat::<f64>::zeros(4, 4 * handles.len());
        let all: f64 = samples.iter().map(|sample| sample.weight).sum();
        for sample in samples {
            let q = (sample.world_point - world_origin) / world_unit;
            let terms = [1.0, q.x, q.y, q.z];
            let weight = sample.weight / all;
            for row in 0..4 {
                for column in 0..4 {
                    matrix[(row, column)] += weight * terms[row] * terms[column];
                }
            }
            for axis in 1..4 {
                matrix[(axis, axis)] += weight * LINEAR_PART;
            }
            if let Some((handle, coordinates)) = sample.handle {
                for k in 0..4 {
                    for row in 0..4 {
                        right[(row, 4 * handle + k)] += weight * terms[row] * coordinates[k];
                    }
                    if k < 3 {
                        right[(1 + k, 4 * handle + k)] += weight * LINEAR_PART * world_unit / handles[handle].radius;
                    }
                }
            }
        }
        let solution = solved(matrix, right);
        let parts = (0..handles.len()).map(|handle| {
            let entry = |row: usize, k: usize| solution[(row, 4 * handle + k)];
            let slope = |k: usize| DVec3::new(entry(1, k), entry(2, k), entry(3, k)) / world_unit;
            ([0, 1, 2, 3].map(|k| entry(0, k)), [0, 1, 2, 3].map(slope))
        });
        Self {
            world_origin,
            parts: parts.collect(),
        }
    }

    /// The coefficients of a handle at a point.
    pub fn at(&self, handle: usize, world_point: DVec3) -> [f64; 4] {
        let (constants, slopes) = &self.parts[handle];
        let q = world_point - self.world_origin;
        std::array::from_fn(|k| constants[k] + slopes[k].dot(q))
    }
}
