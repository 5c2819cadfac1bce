//! The weights of centres: [Φ P; Pᵀ 0] [c; a] = [b; 0], with Φ the kernel between the centres and P the linear
//! functions there.

use faer::Mat;
use glam::DVec3;

use super::constraints::Constraint;
use super::directions::{Directions, directions};
use super::kernel::Weights;
use crate::numerical::dense::solved;

/// The field through the displacements at the centres, four columns per handle.
pub(super) fn weights(centres: &[Constraint], handle_count: usize) -> Weights {
    let points: Vec<DVec3> = centres.iter().map(|centre| centre.point).collect();
    let Directions {
        mean, extended: axes, ..
    } = directions(&points);
    let (count, size) = (points.len(), points.len() + 1 + axes.len());
    let linear = |point: DVec3, term: usize| match term {
        0 => 1.0,
        axis => axes[axis - 1].dot(point - mean),
    };
    let entry = |row: usize, column: usize| match (row < count, column < count) {
        (true, true) => points[row].distance(points[column]).powi(3),
        (true, false) => linear(points[row], column - count),
        (false, true) => linear(points[column], row - count),
        (false, false) => 0.0,
    };
    let right = |row: usize, column: usize| match centres.get(row).and_then(|centre| centre.handle) {
        Some((handle, coordinates)) if handle == column / 4 => coordinates[column % 4],
        _ => 0.0,
    };
    let solution = solved(
        Mat::from_fn(size, size, entry),
        Mat::from_fn(size, 4 * handle_count, right),
    );
    let of_centres = (0..count)
        .flat_map(|row| (0..handle_count).map(move |handle| (row, handle)))
        .map(|(row, handle)| [0, 1, 2, 3].map(|k| solution[(row, 4 * handle + k)]))
        .collect();
    let linear = (0..handle_count)
        .map(|handle| {
            let mut own = [[0.0; 4]; 4];
            for k in 0..4 {
                let column = 4 * handle + k;
                let slope: DVec3 = (0..)
                    .zip(&axes)
                    .map(|(axis, &along)| along * solution[(count + 1 + axis, column)])
                    .sum();
                own[0][k] = solution[(count, column)] - slope.dot(mean);
                for axis in 0..3 {
                    own[1 + axis][k] = slope[axis];
                }
            }
            own
        })
        .collect();
    Weights {
        centres: points,
        of_centres,
        handle_count,
        linear,
    }
}
