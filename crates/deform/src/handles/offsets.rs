//! Offsets: a place for each vertex of a handle, instead of one map for all of them.
//!
//! Methods take a handle's turn from its motion, which is affine. If every vertex has its own place, the motion is the
//! rigid motion that fits the places best, and each vertex has an *offset* from the motion to its place. So a handle of
//! a thousand places binds like any other handle; a thousand handles of one vertex would each need their own bases.

use glam::DVec3;

use super::{Handle, Motion};
use crate::numerical::rigid_fit::RigidMotion;

/// Vertices' offsets from the motions of their handles, in ascending order of the vertices; empty if every handle has a
/// map.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct Offsets {
    of_vertices: Vec<(u32, DVec3)>,
}

impl Offsets {
    /// Returns true if no vertex has an offset.
    pub fn is_empty(&self) -> bool {
        self.of_vertices.is_empty()
    }

    /// The offset of a surface vertex.
    pub fn at(&self, vertex: u32) -> DVec3 {
        let found = self.of_vertices.binary_search_by_key(&vertex, |&(own, _)| own);
        found.map_or(DVec3::ZERO, |place| self.of_vertices[place].1)
    }

    /// The offsets of other vertices, from pairs of a vertex and the one whose offset it takes.
    pub fn of(&self, stands_for: impl Iterator<Item = (u32, u32)>) -> Self {
        let mut of_vertices: Vec<(u32, DVec3)> = stands_for.map(|(own, vertex)| (own, self.at(vertex))).collect();
        of_vertices.retain(|(_, offset)| *offset != DVec3::ZERO);
        of_vertices.sort_unstable_by_key(|(own, _)| *own);
        Self { of_vertices }
    }

    /// The motion of a handle that fits its vertices' displacements best; adds the offsets of these vertices from it.
    pub fn take(&mut self, handle: &Handle, world_rest: &[DVec3], displacements: &[DVec3]) -> Motion {
        let Some(fit) = RigidMotion::fit(world_rest, displacements) else {
            return Motion::default();
        };
        let motion = handle.rigid_motion(&fit);
        self.add(handle, world_rest, displacements, &motion);
        motion
    }

    /// Adds the offsets of a handle's vertices from its motion to their displacements.
    pub fn add(&mut self, handle: &Handle, world_rest: &[DVec3], displacements: &[DVec3], motion: &Motion) {
        let each = handle.vertices.iter().zip(world_rest).zip(displacements);
        let left = each.map(|((&vertex, &rest), &wanted)| (vertex, wanted - motion.displace(handle.coordinates(rest))));
        self.of_vertices.extend(left);
    }

    /// Sorts the offsets, after all handles were taken.
    pub fn sorted(mut self) -> Self {
        self.of_vertices.sort_unstable_by_key(|(vertex, _)| *vertex);
        self
    }
}
