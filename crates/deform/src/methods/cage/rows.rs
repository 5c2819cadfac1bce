//! The coordinates of the samples at which handles are fitted: one row for each sample.

use faer::Mat;
use glam::DVec3;
use rayon::prelude::*;

use super::green::Green;
use super::harmonic::Harmonic;
use super::linear::Unit;
use super::mean_value::MeanValue;
use crate::space::fit_samples::Sample;

/// Mean value coordinates.
pub(super) fn mean_value_rows(coordinates: &MeanValue<'_>, samples: &[Sample], unit: Unit) -> Mat<f64> {
    let points: Vec<DVec3> = samples.iter().map(|sample| unit.local(sample.world_point)).collect();
    let mut rows = Mat::zeros(points.len(), coordinates.count());
    coordinates.at(&points, |sample, weights| {
        for (vertex, (weight, _)) in weights.iter().enumerate() {
            rows[(sample, vertex)] = *weight;
        }
    });
    rows
}

/// Harmonic coordinates of a cage with `vertex_count` vertices.
pub(super) fn harmonic_rows(harmonic: &Harmonic, vertex_count: usize, samples: &[Sample], unit: Unit) -> Mat<f64> {
    let own = samples.iter().map(|sample| harmonic.at(unit.local(sample.world_point)));
    let own: Vec<Vec<f64>> = own.collect();
    Mat::from_fn(samples.len(), vertex_count, |sample, vertex| own[sample][vertex])
}

/// Green coordinates: those of the vertices, then those of the faces.
pub(super) fn green_rows(green: &Green<'_>, points: &[DVec3]) -> Mat<f64> {
    let own = points.par_iter().map(|point| {
        let mut values = vec![0.0; green.count()];
        green.at(*point, &mut values, None);
        values
    });
    let own: Vec<Vec<f64>> = own.collect();
    Mat::from_fn(points.len(), green.count(), |sample, column| own[sample][column])
}
