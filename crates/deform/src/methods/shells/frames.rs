//! The placement of a component that no handle and no fixed vertex holds: only the weights of examples move it.
//!
//! The energy does not determine it. So each shape is moved rigidly before it is shown: the component takes the mean
//! and turn that result from blending those of the examples, relative to rest, by their weights. Vertices that the
//! examples move little have a large weight, so that a body is still while its arm moves along an arc.

use glam::{DMat3, DQuat, DVec3};
use pliant_mesh::SurfaceVertex;

use super::elements::Elements;
use crate::numerical::rigid_fit::best_rotation;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;

/// A vertex that moves by less than this share of the diagonal counts as still.
const STILL: f64 = 1e-3;

/// A component that nothing holds.
#[derive(Debug)]
pub(super) struct Frame {
    /// Its solved vertices.
    vertices: Vec<u32>,
    /// The weight of each of them in the mean and the turn.
    shares: Vec<f64>,
    centre: DVec3,
    /// For each example the centre's shift, and the turn as a rotation vector.
    examples: Vec<(DVec3, DVec3)>,
}

impl Frame {
    /// Finds all components that nothing holds.
    pub fn all(
        problem: &BoundaryProblem,
        partition: &Partition,
        elements: &Elements,
        displacements: &[Vec<DVec3>],
        masses: &[f64],
    ) -> Vec<Self> {
        let mut vertices = vec![Vec::new(); partition.held.len()];
        for (local, &vertex) in (0..).zip(&elements.vertices[..elements.solved_count]) {
            vertices[problem.topology.component(SurfaceVertex(vertex)) as usize].push(local);
        }
        let is_loose = |component: usize| {
            !partition.held[component] && partition.driven.binary_search(&(component as u32)).is_err()
        };
        let size = problem.size();
        let loose = vertices
            .into_iter()
            .enumerate()
            .filter(|(c, own)| is_loose(*c) && !own.is_empty());
        let frame = |(_, vertices): (usize, Vec<u32>)| {
            let share = |&local: &u32| {
                let moved = displacements.iter().map(|own| own[local as usize].length_squared());
                let most = moved.fold(0.0, f64::max);
                masses[local as usize] / ((STILL * size).powi(2) + most)
            };
            let mut shares: Vec<f64> = vertices.iter().map(share).collect();
            if shares.iter().sum::<f64>().is_nan() || shares.iter().sum::<f64>() <= 0.0 {
                // All its masses are zero or undefined, so its vertices count alike.
                shares.fill(1.0);
            }
            let mut frame = Self {
                vertices,
                shares,
                centre: DVec3::ZERO,
                examples: Vec::new(),
            };
            frame.centre = frame.mean(|local| elements.rest[local as usize]);
            for own in displacements {
                let place = |local: u32| elements.rest[local as usize] + own[local as usize];
                let centre = frame.mean(place);
                let turn = frame.turn(&elements.rest, centre, place);
                frame.examples.push((centre - frame.centre, turn.to_scaled_axis()));
            }
            frame
        };
        loose.map(frame).collect()
    }

    /// Its solved vertices.
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// Moves its vertices' displacements to the placement for these weights.
    pub fn place(&self, rest: &[DVec3], weights: &[f64], displacements: &mut [DVec3]) {
        let place = |local: u32| rest[local as usize] + displacements[local as usize];
        let from = self.mean(place);
        let (mut shift, mut turn) = (DVec3::ZERO, DVec3::ZERO);
        for (&weight, (own_shift, own_turn)) in weights.iter().zip(&self.examples) {
            shift += *own_shift * weight;
            turn += *own_turn * weight;
        }
        let turn = DQuat::from_scaled_axis(turn) * self.turn(rest, from, place).conjugate();
        let to = self.centre + shift;
        for &local in &self.vertices {
            let (rest, own) = (rest[local as usize], &mut displacements[local as usize]);
            *own = to + turn * (rest + *own - from) - rest;
        }
    }

    fn mean(&self, place: impl Fn(u32) -> DVec3) -> DVec3 {
        let each = self.vertices.iter().zip(&self.shares);
        let sum: DVec3 = each.map(|(&local, &share)| place(local) * share).sum();
        sum / self.shares.iter().sum::<f64>()
    }

    /// The rotation from rest to these positions, whose mean is `centre`.
    fn turn(&self, rest: &[DVec3], centre: DVec3, place: impl Fn(u32) -> DVec3) -> DQuat {
        let mut covariance = DMat3::ZERO;
        for (&local, &share) in self.vertices.iter().zip(&self.shares) {
            let (from, to) = (rest[local as usize] - self.centre, place(local) - centre);
            covariance += DMat3::from_cols(from * to.x, from * to.y, from * to.z) * share;
        }
        best_rotation(&covariance)
    }
}
