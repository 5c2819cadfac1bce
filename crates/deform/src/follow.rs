//! Loose components travel rigidly with the nearest part of the surface that is being deformed.
//!
//! Real models are many pieces: a helmet has 55 components, and moving its shell alone would tear it apart. A loose
//! component is tied to a *patch*, the surface around the point of the driven components that it comes nearest to,
//! about as large as itself, and takes the rigid motion that fits the patch's displacements best.

use std::collections::VecDeque;

use glam::DVec3;
use pliant_mesh::{Bvh, Surface, SurfaceVertex, Topology};
use rayon::prelude::*;

use crate::rigid_fit::RigidMotion;

/// A component and the patch that it follows.
#[derive(Clone, Debug)]
pub(crate) struct Follower {
    /// The component's vertices.
    vertices: Vec<SurfaceVertex>,
    /// Their rest positions.
    world_rest: Vec<DVec3>,
    /// Vertices of a driven component.
    patch: Vec<SurfaceVertex>,
    /// Their rest positions.
    world_patch_rest: Vec<DVec3>,
}

/// A patch with more vertices than this is thinned out evenly: a fit needs no more.
const PATCH_SAMPLES: usize = 256;

/// A patch reaches at least this many mean edge lengths at its middle.
const PATCH_EDGES: f64 = 3.0;

/// Ties each of the components `following` to the nearest of the components `driven`.
pub(crate) fn followers(surface: &Surface, topology: &Topology, following: &[u32], driven: &[u32]) -> Vec<Follower> {
    if following.is_empty() || driven.is_empty() {
        return Vec::new();
    }
    let is_driven = |corner: SurfaceVertex| driven.binary_search(&topology.component(corner)).is_ok();
    let triangles: Vec<_> = surface
        .triangles
        .iter()
        .copied()
        .filter(|corners| is_driven(corners[0]))
        .collect();
    let nearby = Bvh::build(&surface.positions, &triangles);
    following
        .par_iter()
        .filter_map(|&component| tie(surface, topology, component, &nearby))
        .collect()
}

fn tie(surface: &Surface, topology: &Topology, component: u32, nearby: &Bvh) -> Option<Follower> {
    let vertices = topology.components()[component as usize].vertices.clone();
    let world_rest: Vec<DVec3> = vertices
        .iter()
        .map(|vertex| surface.positions[vertex.index()])
        .collect();
    let mut nearest: Option<(SurfaceVertex, f64)> = None;
    for &point in &world_rest {
        if let Some(found) = nearby.nearest_vertex(point)
            && nearest.is_none_or(|(_, distance)| found.1 < distance)
        {
            nearest = Some(found);
        }
    }
    let (middle, _) = nearest?;
    let (mut low, mut high) = (world_rest[0], world_rest[0]);
    for &point in &world_rest {
        (low, high) = (low.min(point), high.max(point));
    }
    let patch = thinned(patch_around(surface, topology, middle, 0.5 * low.distance(high)));
    let world_patch_rest = patch.iter().map(|vertex| surface.positions[vertex.index()]).collect();
    Some(Follower {
        vertices,
        world_rest,
        patch,
        world_patch_rest,
    })
}

/// The vertices joined to `middle` within a ball, which is at least [`PATCH_EDGES`] edges large; in walking order.
fn patch_around(surface: &Surface, topology: &Topology, middle: SurfaceVertex, radius: f64) -> Vec<SurfaceVertex> {
    let centre = surface.positions[middle.index()];
    let distance = |vertex: SurfaceVertex| surface.positions[vertex.index()].distance(centre);
    let ring = topology.neighbours(middle);
    let edge = ring.iter().map(|&vertex| distance(vertex)).sum::<f64>() / ring.len().max(1) as f64;
    let radius = radius.max(PATCH_EDGES * edge);
    let mut seen = vec![false; surface.positions.len()];
    seen[middle.index()] = true;
    let mut queue = VecDeque::from([middle]);
    let mut patch = Vec::new();
    while let Some(vertex) = queue.pop_front() {
        patch.push(vertex);
        for &next in topology.neighbours(vertex) {
            if !seen[next.index()] && distance(next) <= radius {
                seen[next.index()] = true;
                queue.push_back(next);
            }
        }
    }
    patch
}

fn thinned(patch: Vec<SurfaceVertex>) -> Vec<SurfaceVertex> {
    let stride = patch.len().div_ceil(PATCH_SAMPLES);
    patch.into_iter().step_by(stride.max(1)).collect()
}

/// Writes the followers' displacements, given those of the driven components.
pub(crate) fn carry(followers: &[Follower], displacements: &mut [DVec3]) {
    let motions: Vec<Option<RigidMotion>> = followers
        .par_iter()
        .map(|follower| {
            let patch: Vec<DVec3> = follower
                .patch
                .iter()
                .map(|vertex| displacements[vertex.index()])
                .collect();
            RigidMotion::fit(&follower.world_patch_rest, &patch)
        })
        .collect();
    for (follower, motion) in followers.iter().zip(motions) {
        if let Some(motion) = motion {
            for (vertex, &rest) in follower.vertices.iter().zip(&follower.world_rest) {
                displacements[vertex.index()] = motion.displace(rest);
            }
        }
    }
}
