//! The field of a cage's vertices that were moved by hand, for coordinates that are linear in them.

use glam::{DVec3, Mat3};
use rayon::prelude::*;

use super::harmonic::Harmonic;
use super::linear::Unit;
use super::mean_value::MeanValue;
use super::stored_field::{StoredField, stored_bytes};
use crate::BindError;
use crate::budget::bytes_of;
use crate::method::BindInput;
use crate::space::falloff::Falloff;
use crate::space::hand_field::{ControlMap, HandField};

/// The field of the moves by hand.
#[derive(Debug)]
pub(super) enum ByHand {
    /// A field by stored coordinates: their computation takes longer than a frame may.
    Stored(StoredField),
    /// A field by harmonic coordinates that are too many to be stored.
    Nodes(HandField<HarmonicCoordinates>),
}

/// Coordinates at the nodes of a grid.
#[derive(Debug)]
pub(super) struct HarmonicCoordinates {
    unit: Unit,
    harmonic: Harmonic,
}

/// The most bytes of harmonic coordinates that are stored: above that a frame takes longer to read them than to
/// interpolate them between nodes.
const MOST_STORED: u64 = 512 << 20;

/// The bytes of harmonic coordinates of `point_count` points in a cage with `vertex_count` vertices; 0 if they are not
/// stored.
pub(super) fn kept_bytes(point_count: usize, vertex_count: usize) -> u64 {
    let bytes = bytes_of(point_count, stored_bytes(vertex_count));
    if bytes <= MOST_STORED { bytes } else { 0 }
}

impl ByHand {
    /// Stores mean value coordinates of these vertices.
    ///
    /// # Errors
    /// It was cancelled, or there is no memory.
    pub fn mean_value(
        coordinates: &MeanValue<'_>,
        unit: Unit,
        moving: (Vec<u32>, Falloff),
        world_points: &[DVec3],
        input: &BindInput<'_>,
    ) -> Result<Self, BindError> {
        let points: Vec<DVec3> = world_points.iter().map(|point| unit.local(*point)).collect();
        let count = coordinates.count();
        let field = StoredField::of(count, moving, &points, unit.length, input.cancel, |points, visit| {
            coordinates.at(points, visit);
        });
        Ok(Self::Stored(field?))
    }

    /// Makes the field by harmonic coordinates of these vertices in a cage with `count` vertices.
    ///
    /// # Errors
    /// It was cancelled, or there is no memory.
    pub fn harmonic(
        harmonic: Harmonic,
        unit: Unit,
        (vertices, falloff): (Vec<u32>, Falloff),
        world_points: Vec<DVec3>,
        count: usize,
        input: &BindInput<'_>,
    ) -> Result<Self, BindError> {
        if kept_bytes(vertices.len(), count) == 0 {
            let map = HarmonicCoordinates { unit, harmonic };
            return Ok(Self::Nodes(HandField::new(map, vertices, world_points, falloff)));
        }
        let points: Vec<DVec3> = world_points.iter().map(|point| unit.local(*point)).collect();
        let moving = (vertices, falloff);
        let field = StoredField::of(count, moving, &points, unit.length, input.cancel, |points, visit| {
            let mut own = vec![(0.0, DVec3::ZERO); count];
            for (place, &point) in points.iter().enumerate() {
                own.fill((0.0, DVec3::ZERO));
                harmonic.weights(point, |node, weight, gradient| {
                    for (vertex, own) in own.iter_mut().enumerate() {
                        let value = harmonic.value(node, vertex);
                        own.0 += weight * value;
                        own.1 += gradient * value;
                    }
                });
                visit(place, &own);
            }
        });
        Ok(Self::Stored(field?))
    }

    pub fn add(&self, moves: &[DVec3], displacements: &mut [DVec3]) {
        match self {
            Self::Stored(field) => field.add(moves, displacements),
            Self::Nodes(field) => field.add(moves, displacements),
        }
    }

    pub fn add_jacobians(&self, moves: &[DVec3], out: &mut [Mat3]) {
        match self {
            Self::Stored(field) => field.add_jacobians(moves, out),
            Self::Nodes(field) => field.add_jacobians(moves, out),
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
