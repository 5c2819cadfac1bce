//! The principal directions of points, divided into those with extent and those without.

use glam::{DMat3, DVec3};

use crate::numerical::eigen::eigenvectors;

/// Points with less extent than this along a direction are flat in it: a linear function along it is undetermined, or
/// only noise.
const FLAT: f64 = 1e-7;

/// The extent of points.
pub(super) struct Directions {
    pub mean: DVec3,
    /// The unit directions with extent.
    pub extended: Vec<DVec3>,
    /// The unit directions without extent.
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
