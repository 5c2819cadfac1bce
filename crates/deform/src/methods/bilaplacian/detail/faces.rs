//! The base's triangles, and the normals of its vertices.

use glam::DVec3;
use pliant_mesh::SurfaceVertex;
use rayon::prelude::*;

use super::donors::NONE;
use crate::numerical::lists::Lists;
use crate::numerical::rows::CHUNK;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::patch::Patch;

/// The triangles of a patch that have a row among their corners.
#[derive(Debug)]
pub(crate) struct Faces {
    /// The corners of each triangle, as local vertices of the patch.
    pub corners: Vec<[u32; 3]>,
    /// Their places in the flattened `corners`, by local vertex.
    slots: Lists,
}

impl Faces {
    /// The triangles around the patch's rows.
    pub fn of(patch: &Patch, problem: &BoundaryProblem<'_>) -> Self {
        let (triangles, topology) = (&problem.surface.triangles, problem.topology);
        let mut local_of = vec![NONE; patch.vertices.last().map_or(0, |&last| last as usize + 1)];
        for (local, &vertex) in (0..).zip(&patch.vertices) {
            local_of[vertex as usize] = local;
        }
        let mut corners = Vec::new();
        let mut is_taken = vec![false; triangles.len()];
        for &local in &patch.rows {
            let vertex = SurfaceVertex(patch.vertices[local as usize]);
            for face in topology.faces(vertex, triangles) {
                if !std::mem::replace(&mut is_taken[face as usize], true) {
                    corners.push(triangles[face as usize].map(|corner| local_of[corner.index()]));
                }
            }
        }
        let pairs = corners.as_flattened().iter().copied().zip(0..);
        let slots = Lists::of(patch.vertices.len(), pairs);
        Self { corners, slots }
    }

    /// The places of a local vertex among the flattened `corners`: three times the triangle, plus the corner.
    #[inline]
    pub fn slots(&self, local: usize) -> &[u32] {
        self.slots.at(local)
    }

    /// The triangles around a local vertex.
    #[inline]
    pub fn around(&self, local: usize) -> impl Iterator<Item = u32> {
        self.slots(local).iter().map(|slot| slot / 3)
    }

    /// Fills in the unit normal of each local vertex: the direction of its triangles' area vectors in sum, zero if it
    /// has none.
    pub fn normals(&self, points: &[DVec3], normals: &mut Vec<DVec3>) {
        let normal = |local: usize| {
            let area = |face: u32| {
                let [a, b, c] = self.corners[face as usize].map(|corner| points[corner as usize]);
                (b - a).cross(c - a)
            };
            let sum: DVec3 = self.around(local).map(area).sum();
            sum.try_normalize().unwrap_or(DVec3::ZERO)
        };
        (0..self.slots.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(normal)
            .collect_into_vec(normals);
    }
}
