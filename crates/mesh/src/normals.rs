//! Vertex normals, every frame.

use glam::DVec3;
use rayon::prelude::*;

use crate::surface::corners;
use crate::{SurfaceVertex, Topology};

/// The unit normal of every vertex into `out`: the mean of its triangles' normals weighted by area, zero where they
/// cancel or have no area.
///
/// Each vertex gathers from its own triangles, so the sums are the same bits whatever the number of threads.
pub fn vertex_normals(
    triangles: &[[SurfaceVertex; 3]],
    topology: &Topology,
    positions: &[DVec3],
    out: &mut Vec<DVec3>,
) {
    out.resize(positions.len(), DVec3::ZERO);
    out.par_chunks_mut(2048).enumerate().for_each(|(piece, normals)| {
        for (i, normal) in normals.iter_mut().enumerate() {
            let v = SurfaceVertex((piece * 2048 + i) as u32);
            let mut sum = DVec3::ZERO;
            for &t in topology.faces(v) {
                let [a, b, c] = corners(triangles[t as usize], positions);
                sum += (b - a).cross(c - a);
            }
            *normal = sum.normalize_or_zero();
        }
    });
}
