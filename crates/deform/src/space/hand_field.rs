//! The displacements by control points moved by hand: d(p) = Σ_i λ_i(p) D_i, faded towards fixed vertices.

use std::fmt::Debug;

use glam::{DMat3, DVec3, Mat3};
use rayon::prelude::*;

use super::falloff::Falloff;
use crate::handles::FRAME_CHUNK;

/// A field that is linear in the control points' displacements.
pub(crate) trait ControlMap: Debug + Send + Sync {
    /// The factors of the weights, from the control points' displacements.
    fn coefficients(&self, displacements: &[DVec3]) -> Vec<DVec3> {
        displacements.to_vec()
    }

    /// Visits the factors with a weight at the vertex of this place in [`HandField::vertices`]: number, weight, and the
    /// weight's gradient per world unit.
    fn weights(&self, place: usize, world_point: DVec3, visit: impl FnMut(usize, f64, DVec3));
}

/// The field at every vertex that moves.
#[derive(Debug)]
pub(crate) struct HandField<M> {
    map: M,
    /// The vertices, ascending, and their rest positions.
    vertices: Vec<u32>,
    world_points: Vec<DVec3>,
    falloff: Falloff,
}

impl<M: ControlMap> HandField<M> {
    /// The field at these vertices, ascending, with these rest positions and this fading.
    pub fn new(map: M, vertices: Vec<u32>, world_points: Vec<DVec3>, falloff: Falloff) -> Self {
        Self {
            map,
            vertices,
            world_points,
            falloff,
        }
    }

    /// Adds the displacements of the vertices.
    pub fn add(&self, controls: &[DVec3], displacements: &mut [DVec3]) {
        let coefficients = self.map.coefficients(controls);
        self.visit(displacements, |place, own| {
            let mut sum = DVec3::ZERO;
            self.map.weights(place, self.world_points[place], |number, weight, _| {
                sum += coefficients[number] * weight;
            });
            *own += sum * self.falloff.at(place).0;
        });
    }

    /// Adds the Jacobians of the displacements.
    pub fn add_jacobians(&self, controls: &[DVec3], out: &mut [Mat3]) {
        let coefficients = self.map.coefficients(controls);
        self.visit(out, |place, own| {
            let (mut sum, mut jacobian) = (DVec3::ZERO, DMat3::ZERO);
            self.map
                .weights(place, self.world_points[place], |number, weight, gradient| {
                    sum += coefficients[number] * weight;
                    jacobian += outer(coefficients[number], gradient);
                });
            let (factor, slope) = self.falloff.at(place);
            *own += (jacobian * factor + outer(sum, slope)).as_mat3();
        });
    }

    /// Each vertex' place and entry.
    fn visit<T: Send>(&self, out: &mut [T], change: impl Fn(usize, &mut T) + Sync) {
        out.par_chunks_mut(FRAME_CHUNK).enumerate().for_each(|(chunk, out)| {
            let first = chunk * FRAME_CHUNK;
            let place = |end: usize| self.vertices.partition_point(|&vertex| (vertex as usize) < end);
            for place in place(first)..place(first + out.len()) {
                change(place, &mut out[self.vertices[place] as usize - first]);
            }
        });
    }
}

/// a bᵀ.
pub(crate) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
