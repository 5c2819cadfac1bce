//! The fields of mean value and of harmonic coordinates: linear in the cage's vertices, and so in the handles' motions.

use faer::Mat;
use glam::DVec3;
use rayon::prelude::*;

use super::harmonic::Harmonic;
use super::mean_value::MeanValue;
use crate::space::field::{Coefficients, SpaceMap};

/// The map between world coordinates and the cage's unit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unit {
    pub world_origin: DVec3,
    pub length: f64,
}

/// The field of mean value coordinates.
pub(super) struct MeanValueMap<'a> {
    pub unit: Unit,
    pub coordinates: MeanValue<'a>,
    /// One row for each vertex of the cage and four columns for each handle.
    pub controls: &'a Mat<f64>,
}

/// The field of harmonic coordinates.
pub(super) struct HarmonicMap<'a> {
    unit: Unit,
    harmonic: &'a Harmonic,
    /// One entry for each node and handle, row-major.
    nodes: Vec<[f64; 4]>,
    handle_count: usize,
}

impl Unit {
    pub fn local(&self, world_point: DVec3) -> DVec3 {
        (world_point - self.world_origin) / self.length
    }

    pub fn world(&self, point: DVec3) -> DVec3 {
        self.world_origin + point * self.length
    }
}

impl SpaceMap for MeanValueMap<'_> {
    fn coefficients(&self, world_points: &[DVec3], out: &mut [Coefficients]) {
        let points: Vec<DVec3> = world_points.iter().map(|point| self.unit.local(*point)).collect();
        let count = self.controls.ncols() / 4;
        self.coordinates.at(&points, |place, weights| {
            for (handle, out) in out[place * count..][..count].iter_mut().enumerate() {
                for k in 0..4 {
                    let column = self.controls.col_as_slice(4 * handle + k);
                    let (mut value, mut gradient) = (0.0, DVec3::ZERO);
                    for ((weight, slope), control) in weights.iter().zip(column) {
                        value += weight * control;
                        gradient += *slope * *control;
                    }
                    (out.value[k], out.gradient[k]) = (value, gradient / self.unit.length);
                }
            }
        });
    }
}

impl<'a> HarmonicMap<'a> {
    pub fn new(unit: Unit, harmonic: &'a Harmonic, controls: &Mat<f64>) -> Self {
        let handle_count = controls.ncols() / 4;
        let mut nodes = vec![[0.0; 4]; harmonic.node_count() * handle_count];
        let of_nodes = nodes.par_chunks_exact_mut(handle_count.max(1)).enumerate();
        of_nodes.for_each(|(node, own)| {
            for vertex in 0..controls.nrows() {
                let value = harmonic.value(node, vertex);
                for (handle, own) in own.iter_mut().enumerate() {
                    for k in 0..4 {
                        own[k] += value * controls[(vertex, 4 * handle + k)];
                    }
                }
            }
        });
        Self {
            unit,
            harmonic,
            nodes,
            handle_count,
        }
    }
}

impl SpaceMap for HarmonicMap<'_> {
    fn coefficients(&self, world_points: &[DVec3], out: &mut [Coefficients]) {
        let count = self.handle_count;
        for (&point, out) in world_points.iter().zip(out.chunks_exact_mut(count)) {
            self.harmonic.weights(self.unit.local(point), |node, weight, gradient| {
                for (out, value) in out.iter_mut().zip(&self.nodes[node * count..][..count]) {
                    for k in 0..4 {
                        out.value[k] += weight * value[k];
                        out.gradient[k] += gradient * (value[k] / self.unit.length);
                    }
                }
            });
        }
    }
}
