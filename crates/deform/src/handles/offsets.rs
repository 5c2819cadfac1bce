//! Places for a handle's vertices beside one map for all of them.
//!
//! Methods take a handle's turn from its motion, which is affine. Where every vertex has a place of its own, the motion
//! is the rigid one that fits the places best, and an *offset* at each vertex is what is left. So a handle of a
//! thousand places binds as any other handle, where a thousand handles of one vertex would each have bases of their
//! own.

use glam::DVec3;

use super::{Handle, Motion};
use crate::numerical::rigid_fit::RigidMotion;

/// What vertices are displaced by beside the motions of their handles, ascending; none where every handle has a map.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct Offsets {
    of_vertices: Vec<(u32, DVec3)>,
}

impl Offsets {
    /// Whether every handle's motion is all that it does.
    pub fn is_empty(&self) -> bool {
        self.of_vertices.is_empty()
    }

    /// The offset of a surface vertex.
    pub fn at(&self, vertex: u32) -> DVec3 {
        let found = self.of_vertices.binary_search_by_key(&vertex, |&(own, _)| own);
        found.map_or(DVec3::ZERO, |place| self.of_vertices[place].1)
    }

    /// Those of other vertices, each of which stands for one of these.
    pub fn of(&self, stands_for: impl Iterator<Item = (u32, u32)>) -> Self {
        let mut of_vertices: Vec<(u32, DVec3)> = stands_for.map(|(own, vertex)| (own, self.at(vertex))).collect();
        of_vertices.retain(|(_, offset)| *offset != DVec3::ZERO);
        of_vertices.sort_unstable_by_key(|(own, _)| *own);
        Self { of_vertices }
    }

    /// The motion of a handle whose vertices are displaced so, one displacement for each; adds what it leaves.
    pub fn take(&mut self, handle: &Handle, world_rest: &[DVec3], displacements: &[DVec3]) -> Motion {
        let Some(fit) = RigidMotion::fit(world_rest, displacements) else {
            return Motion::default();
        };
        let motion = fit.motion_of(handle);
        let each = handle.vertices.iter().zip(world_rest).zip(displacements);
        let left = each.map(|((&vertex, &rest), &wanted)| (vertex, wanted - motion.displace(handle.coordinates(rest))));
        self.of_vertices.extend(left);
        motion
    }

    /// In order, once all handles are taken.
    pub fn sorted(mut self) -> Self {
        self.of_vertices.sort_unstable_by_key(|(vertex, _)| *vertex);
        self
    }
}
