//! The weights of centres: [Φ P; Pᵀ 0] [c; a] = [b; 0], Φ the kernel between the centres and P the linear functions
//! there.

use faer::Mat;
use glam::{DMat3, DVec3};

use super::constraints::Constraint;
use super::kernel::Weights;
use crate::numerical::dense::solved;
use crate::numerical::eigen::eigenvectors;

/// Points that reach less far than this across a direction are flat in it: a linear function there says nothing, or is
/// nothing but noise.
const FLAT: f64 = 1e-7;

/// The field through the displacements at the centres, four columns a handle.
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

/// Where points extend.
pub(super) struct Directions {
    mean: DVec3,
    /// The unit directions in which they extend.
    extended: Vec<DVec3>,
    /// Those in which they do not.
    pub flat: Vec<DVec3>,
}

/// The principal directions of points.
pub(super) fn directions(points: &[DVec3]) -> Directions {
    let mean = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    let mut spread = DMat3::ZERO;
    for point in points {
        let from = *point - mean;
        spread += DMat3::from_cols(from * from.x, from * from.y, from * from.z);
    }
    let (axes, _) = eigenvectors(&spread);
    let reach = |axis: DVec3| {
        let along = points.iter().map(|point| axis.dot(*point - mean).abs());
        along.fold(0.0, f64::max)
    };
    let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
    let (extended, flat) = axes.into_iter().partition(|&axis| reach(axis) > FLAT);
    Directions { mean, extended, flat }
}
