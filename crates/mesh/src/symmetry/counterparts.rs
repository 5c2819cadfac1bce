//! The pairs of vertices that are each other's mirror images.
//!
//! The mesh of a scan is never symmetric vertex by vertex. A vertex' image is somewhere on the other side's surface,
//! and the vertex copies the vertex nearest to its image: in this direction, no vertex between images is left out. Limbs
//! that stand differently on both sides are paired along the surface ([`grown`]).

use glam::DVec3;
use rayon::prelude::*;

use super::grown::grown;
use super::plane::MirrorPlane;
use crate::{Bvh, Cancel, Cancelled, Progress, Surface, SurfaceVertex, Topology};

/// The number of vertices between two checks of the progress.
const BATCH: usize = 16_384;

/// The vertex nearest to the mirror image of `vertex`; `None` if it is farther away than its longest edge. `bvh` is
/// that of the same `positions`.
pub fn image_of(
    positions: &[DVec3],
    topology: &Topology,
    bvh: &Bvh,
    plane: MirrorPlane,
    vertex: SurfaceVertex,
) -> Option<SurfaceVertex> {
    let (nearest, distance) = bvh.nearest_vertex(plane.mirrored(positions[vertex.index()]))?;
    let here = positions[nearest.index()];
    let edges = topology.neighbours(nearest).iter();
    let longest = edges.map(|v| here.distance(positions[v.index()])).fold(0.0, f64::max);
    (distance <= longest).then_some(nearest)
}

/// For every vertex its counterparts on the other side.
#[derive(Clone, Debug)]
pub struct Counterparts {
    offsets: Vec<u32>,
    vertices: Vec<SurfaceVertex>,
}

impl Counterparts {
    /// Finds every vertex' image; `bvh` is that of the same surface.
    ///
    /// # Errors
    /// If it was cancelled.
    pub fn find(
        surface: &Surface,
        topology: &Topology,
        bvh: &Bvh,
        plane: MirrorPlane,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let positions = &surface.positions;
        let count = positions.len();
        let mut images: Vec<Option<SurfaceVertex>> = Vec::with_capacity(count);
        for start in (0..count).step_by(BATCH) {
            cancel.check()?;
            let batch = (start..(start + BATCH).min(count)).into_par_iter();
            images.par_extend(batch.map(|v| image_of(positions, topology, bvh, plane, SurfaceVertex(v as u32))));
            progress.set(start as f32 / count as f32);
        }
        let images = grown(surface, topology, plane, images, cancel)?;
        let pairs = images.iter().enumerate().filter_map(|(vertex, image)| {
            let vertex = SurfaceVertex(vertex as u32);
            image.map(|image| [vertex, image])
        });
        let mut both_ways: Vec<[SurfaceVertex; 2]> = pairs.flat_map(|[a, b]| [[a, b], [b, a]]).collect();
        both_ways.par_sort_unstable();
        both_ways.dedup();
        let mut offsets = vec![0_u32; count + 1];
        for [vertex, _] in &both_ways {
            offsets[vertex.index() + 1] += 1;
        }
        for vertex in 0..count {
            offsets[vertex + 1] += offsets[vertex];
        }
        let vertices = both_ways.into_iter().map(|[_, counterpart]| counterpart).collect();
        Ok(Self { offsets, vertices })
    }

    /// The counterparts of this vertex, ascending: the vertex nearest to its image, and those whose image is nearest to
    /// it. A vertex at the plane may be its own. Empty if the shape lacks the other side.
    pub fn of(&self, vertex: SurfaceVertex) -> &[SurfaceVertex] {
        let [from, to] = [vertex.index(), vertex.index() + 1].map(|place| self.offsets[place] as usize);
        &self.vertices[from..to]
    }
}
