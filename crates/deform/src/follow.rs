//! Loose components travel rigidly with the nearest part of the surface that is being deformed.
//!
//! Real models are many pieces: a helmet has 55 components, and moving its shell alone would tear it apart. A loose
//! component is tied to a *patch*, the surface around the point of the driven components that it comes nearest to,
//! about as large as itself, and takes the rigid motion that fits the patch's displacements best. One that bends along
//! has such a tie at several of its vertices, evenly spread, and between them the motions are blended as in an embedded
//! deformation (Sumner et al. 2007): each place by the four nearest, with weights (1 − d/d₅)², d₅ the fifth's distance.

use std::collections::VecDeque;

use glam::DVec3;
use pliant_mesh::{Bvh, Surface, SurfaceVertex, Topology};
use rayon::prelude::*;

use crate::Loose;
use crate::rigid_fit::RigidMotion;

/// A component and what it follows.
#[derive(Clone, Debug)]
pub(crate) struct Follower {
    /// The component's vertices.
    vertices: Vec<SurfaceVertex>,
    /// Their rest positions.
    world_rest: Vec<DVec3>,
    /// The places where it is tied.
    ties: Vec<Tie>,
    /// Of each vertex the ties that move it, with their shares, whose sum is 1; empty where the first one moves all.
    shares: Vec<[(u16, f64); BLENDED]>,
}

/// The patch that a place of a component follows.
#[derive(Clone, Debug)]
struct Tie {
    /// Vertices of a driven component.
    patch: Vec<SurfaceVertex>,
    /// Their rest positions.
    world_rest: Vec<DVec3>,
}

/// How many ties move a vertex of a component that bends along.
const BLENDED: usize = 4;

/// At how many of its vertices a component that bends along is tied, at most.
const MOST_TIES: usize = 64;

/// A patch with more vertices than this is thinned out evenly: a fit needs no more.
const PATCH_SAMPLES: usize = 256;

/// A patch reaches at least this many mean edge lengths at its middle.
const PATCH_EDGES: f64 = 3.0;

/// Ties each of the components `following` to the nearest of the components `driven`.
pub(crate) fn followers(
    surface: &Surface,
    topology: &Topology,
    following: &[(u32, Loose)],
    driven: &[u32],
) -> Vec<Follower> {
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
        .filter_map(|&(component, how)| {
            let vertices = topology.vertices_of(component).collect();
            match how {
                Loose::Follow => rigid(surface, topology, vertices, &nearby),
                Loose::Bend => bending(surface, topology, vertices, &nearby),
                Loose::Rest => None,
            }
        })
        .collect()
}

fn positions_of(surface: &Surface, vertices: &[SurfaceVertex]) -> Vec<DVec3> {
    vertices
        .iter()
        .map(|vertex| surface.positions[vertex.index()])
        .collect()
}

fn rigid(surface: &Surface, topology: &Topology, vertices: Vec<SurfaceVertex>, nearby: &Bvh) -> Option<Follower> {
    let world_rest = positions_of(surface, &vertices);
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
    Some(Follower {
        vertices,
        world_rest,
        ties: vec![tie(surface, topology, middle, 0.5 * low.distance(high))],
        shares: Vec::new(),
    })
}

fn bending(surface: &Surface, topology: &Topology, vertices: Vec<SurfaceVertex>, nearby: &Bvh) -> Option<Follower> {
    let world_rest = positions_of(surface, &vertices);
    let (knots, spacing) = spread(&world_rest);
    let ties = knots
        .iter()
        .map(|&knot| {
            let (middle, _) = nearby.nearest_vertex(world_rest[knot])?;
            Some(tie(surface, topology, middle, 0.5 * spacing))
        })
        .collect::<Option<Vec<Tie>>>()?;
    let shares = world_rest
        .par_iter()
        .map(|&point| shares_at(point, knots.iter().map(|&knot| world_rest[knot])))
        .collect();
    Some(Follower {
        vertices,
        world_rest,
        ties,
        shares,
    })
}

/// At most [`MOST_TIES`] of the points, each as far as can be from those before it, and how far apart they are in the
/// end.
fn spread(points: &[DVec3]) -> (Vec<usize>, f64) {
    let mut distances = vec![f64::INFINITY; points.len()];
    let (mut chosen, mut next, mut spacing) = (Vec::new(), 0, 0.0);
    while chosen.len() < MOST_TIES.min(points.len()) {
        chosen.push(next);
        let mut farthest = 0.0;
        let from = points[next];
        for (number, (distance, point)) in distances.iter_mut().zip(points).enumerate() {
            *distance = distance.min(point.distance(from));
            if *distance > farthest {
                (farthest, next) = (*distance, number);
            }
        }
        spacing = farthest;
        if farthest == 0.0 {
            break;
        }
    }
    (chosen, spacing)
}

/// The nearest ties and their shares.
fn shares_at(point: DVec3, ties: impl Iterator<Item = DVec3>) -> [(u16, f64); BLENDED] {
    let mut nearest = [(0_u16, f64::INFINITY); BLENDED + 1];
    for (number, tie) in (0..).zip(ties) {
        let distance = tie.distance(point);
        let place = nearest.partition_point(|&(_, nearer)| nearer <= distance);
        if place < nearest.len() {
            nearest[place..].rotate_right(1);
            nearest[place] = (number, distance);
        }
    }
    let beyond = nearest[BLENDED].1;
    let mut shares = [(0, 0.0); BLENDED];
    for (share, (number, distance)) in shares.iter_mut().zip(nearest) {
        let weight = match distance {
            _ if distance.is_infinite() => 0.0,
            // As few ties as are blended: there is no fifth.
            _ if beyond.is_infinite() => 1.0 / (1e-12 + distance),
            _ => (1.0 - distance / beyond.max(f64::MIN_POSITIVE)).max(0.0).powi(2),
        };
        *share = (number, weight);
    }
    let sum: f64 = shares.iter().map(|(_, weight)| weight).sum();
    if sum > 0.0 {
        shares.iter_mut().for_each(|(_, weight)| *weight /= sum);
    } else {
        shares[0].1 = 1.0;
    }
    shares
}

fn tie(surface: &Surface, topology: &Topology, middle: SurfaceVertex, radius: f64) -> Tie {
    let patch = thinned(patch_around(surface, topology, middle, radius));
    Tie {
        world_rest: positions_of(surface, &patch),
        patch,
    }
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
    let motions: Vec<Vec<Option<RigidMotion>>> = followers
        .par_iter()
        .map(|follower| {
            let motion = |tie: &Tie| {
                let moved: Vec<DVec3> = tie.patch.iter().map(|vertex| displacements[vertex.index()]).collect();
                RigidMotion::fit(&tie.world_rest, &moved)
            };
            follower.ties.par_iter().map(motion).collect()
        })
        .collect();
    for (follower, motions) in followers.iter().zip(motions) {
        let moved = |tie: u16, rest: DVec3| {
            let motion = motions.get(usize::from(tie)).and_then(Option::as_ref);
            motion.map(|motion| motion.displace(rest))
        };
        for (number, (vertex, &rest)) in follower.vertices.iter().zip(&follower.world_rest).enumerate() {
            let displacement = match follower.shares.get(number) {
                None => moved(0, rest),
                Some(shares) => shares
                    .iter()
                    .filter_map(|&(tie, share)| Some(moved(tie, rest)? * share))
                    .reduce(|sum, more| sum + more),
            };
            if let Some(displacement) = displacement {
                displacements[vertex.index()] = displacement;
            }
        }
    }
}
