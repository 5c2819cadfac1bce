//! What the hand's moves of a cage's vertices do with coordinates that are linear in them.

use glam::{DVec3, Mat3, Vec3};
use rayon::prelude::*;

use super::harmonic::Harmonic;
use super::linear::Unit;
use super::mean_value::MeanValue;
use crate::BindError;
use crate::budget::filled;
use crate::method::BindInput;
use crate::space::hand_field::{ControlMap, HandField};

/// The field of the hand's moves.
#[derive(Debug)]
pub(super) enum ByHand {
    MeanValue(HandField<StoredCoordinates>),
    Harmonic(HandField<HarmonicCoordinates>),
}

/// Coordinates that are kept: to compute them takes longer than a frame may.
#[derive(Debug)]
pub(super) struct StoredCoordinates {
    count: usize,
    /// Row-major: a row a vertex.
    values: Vec<f64>,
    /// Per world unit; in single precision, because only normals are made of them.
    gradients: Vec<Vec3>,
}

/// Coordinates at the nodes of a grid.
#[derive(Debug)]
pub(super) struct HarmonicCoordinates {
    pub unit: Unit,
    pub harmonic: Harmonic,
}

/// Points whose coordinates are computed at once.
const AT_ONCE: usize = 256;

impl ByHand {
    pub fn add(&self, moves: &[DVec3], displacements: &mut [DVec3]) {
        match self {
            Self::MeanValue(field) => field.add(moves, displacements),
            Self::Harmonic(field) => field.add(moves, displacements),
        }
    }

    pub fn add_jacobians(&self, moves: &[DVec3], out: &mut [Mat3]) {
        match self {
            Self::MeanValue(field) => field.add_jacobians(moves, out),
            Self::Harmonic(field) => field.add_jacobians(moves, out),
        }
    }
}

/// Bytes of a vertex' stored coordinates in a cage with so many vertices.
pub(super) fn stored_bytes(vertex_count: usize) -> usize {
    vertex_count * (size_of::<f64>() + size_of::<Vec3>()) + size_of::<DVec3>()
}

impl StoredCoordinates {
    /// Those of mean values at these points.
    ///
    /// # Errors
    /// It was cancelled, or there is no memory.
    pub fn mean_value(
        coordinates: &MeanValue<'_>,
        unit: Unit,
        world_points: &[DVec3],
        input: &BindInput<'_>,
    ) -> Result<Self, BindError> {
        let count = coordinates.count();
        let out_of_memory = |_| BindError::OutOfMemory {
            free_count: input.partition.solved.len(),
        };
        let mut values = filled(0.0, world_points.len() * count).map_err(out_of_memory)?;
        let mut gradients = filled(Vec3::ZERO, world_points.len() * count).map_err(out_of_memory)?;
        let rows = values
            .par_chunks_mut(AT_ONCE * count)
            .zip(gradients.par_chunks_mut(AT_ONCE * count));
        let chunks = world_points.par_chunks(AT_ONCE).zip(rows);
        chunks.try_for_each(|(points, (values, gradients))| {
            input.cancel.check()?;
            let points: Vec<DVec3> = points.iter().map(|point| unit.local(*point)).collect();
            coordinates.at(&points, |place, weights| {
                let row = place * count..(place + 1) * count;
                let out = values[row.clone()].iter_mut().zip(&mut gradients[row]);
                for ((value, gradient), weight) in out.zip(weights) {
                    *value = weight.0;
                    *gradient = (weight.1 / unit.length).as_vec3();
                }
            });
            Ok::<_, BindError>(())
        })?;
        Ok(Self {
            count,
            values,
            gradients,
        })
    }
}

impl ControlMap for StoredCoordinates {
    fn weights(&self, place: usize, _: DVec3, mut visit: impl FnMut(usize, f64, DVec3)) {
        let row = place * self.count..(place + 1) * self.count;
        let own = self.values[row.clone()].iter().zip(&self.gradients[row]);
        for (vertex, (value, gradient)) in own.enumerate() {
            visit(vertex, *value, gradient.as_dvec3());
        }
    }
}

impl ControlMap for HarmonicCoordinates {
    /// The displacement of each node.
    fn coefficients(&self, displacements: &[DVec3]) -> Vec<DVec3> {
        let at = |node: usize| {
            let terms = displacements.iter().enumerate();
            terms
                .map(|(vertex, own)| *own * self.harmonic.value(node, vertex))
                .sum::<DVec3>()
        };
        (0..self.harmonic.node_count()).into_par_iter().map(at).collect()
    }

    fn weights(&self, _: usize, world_point: DVec3, mut visit: impl FnMut(usize, f64, DVec3)) {
        self.harmonic
            .weights(self.unit.local(world_point), |node, weight, gradient| {
                visit(node, weight, gradient / self.unit.length);
            });
    }
}
