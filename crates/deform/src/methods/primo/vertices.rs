//! Vertices from prisms: each free vertex moves to the mean of its positions under the prisms around it.

use glam::DVec3;
use pliant_mesh::{Surface, SurfaceVertex, Topology};
use rayon::prelude::*;

use super::pose::Pose;
use super::prisms::{NONE, Prisms, ground_of};
use crate::Role;
use crate::numerical::rows::CHUNK;

/// The free vertices of solved prisms.
#[derive(Debug)]
pub(crate) struct Vertices {
    /// Surface vertices, ascending.
    pub vertices: Vec<u32>,
    offsets: Vec<u32>,
    /// The bodies around each vertex and its position relative to their rest centres.
    around: Vec<(u32, DVec3)>,
}

impl Vertices {
    /// `centres` are the bodies', relative to `world_origin`.
    pub fn of(
        surface: &Surface,
        topology: &Topology,
        roles: &[Role],
        prisms: &Prisms,
        centres: &[DVec3],
        world_origin: DVec3,
    ) -> Self {
        let mut own = Self {
            vertices: Vec::new(),
            offsets: vec![0],
            around: Vec::new(),
        };
        for (vertex, &role) in roles.iter().enumerate() {
            let bodies = topology.faces(SurfaceVertex(vertex as u32), &surface.triangles);
            let body = |face: u32| prisms.body_of[face as usize];
            if ground_of(role) != NONE || bodies.clone().map(body).all(|body| body as usize >= prisms.count()) {
                continue;
            }
            let point = surface.positions[vertex] - world_origin;
            own.vertices.push(vertex as u32);
            let arm = |body: u32| (body, point - centres[body as usize]);
            own.around.extend(bodies.map(body).map(arm));
            own.offsets.push(own.around.len() as u32);
        }
        own
    }

    /// Writes their displacements, one per surface vertex.
    pub fn write(&self, pose: &Pose, displacements: &mut [DVec3]) {
        let means: Vec<DVec3> = self
            .offsets
            .par_windows(2)
            .with_min_len(CHUNK)
            .map(|bounds| {
                let around = &self.around[bounds[0] as usize..bounds[1] as usize];
                let sum: DVec3 = around
                    .iter()
                    .map(|&(body, arm)| pose.displacement(body as usize, arm))
                    .sum();
                sum / around.len() as f64
            })
            .collect();
        for (&vertex, mean) in self.vertices.iter().zip(means) {
            displacements[vertex as usize] = mean;
        }
    }
}
