//! Loose components move rigidly with the nearest part of the deformed surface.
//!
//! Real models have many pieces: a helmet has 55 components, and moving its hull alone would tear it apart. A loose
//! component is tied to a *patch*: the part of a driven component around the touched or nearest point, about as large
//! as the loose component. It takes the rigid motion that fits the patch's displacements best. A component that touches
//! a larger loose component more than any driven one (a rivet on a strap) moves with that one.
//!
//! A component that bends along has ties at several of its vertices, evenly spread. Between them the motions are
//! blended as in an embedded deformation [SSP07]: at each vertex the four nearest, with weights (1 − d/d₅)², d₅ being
//! the distance of the fifth.

use std::collections::{BTreeMap, HashSet};

use glam::DVec3;
use pliant_mesh::{Bvh, Cancel, Cancelled, Surface, SurfaceVertex, Topology};
use rayon::prelude::*;

use super::owners::{CRUMBS, Owner, end_of_chain, hierarchy, owners};
use crate::Loose;
use crate::numerical::rigid_fit::RigidMotion;

/// All components that follow, and their ties.
#[derive(Clone, Debug, Default)]
pub(crate) struct Followers {
    /// The places of ties, each once.
    ties: Vec<Tie>,
    /// From this place on they are on components that bend along.
    first_on_bending: usize,
    rigid: Vec<Rigid>,
    bending: Vec<Bending>,
}

/// A vertex that moves with one tie, like all vertices of its component.
#[derive(Clone, Copy, Debug)]
struct Rigid {
    vertex: SurfaceVertex,
    tie: u32,
    world_rest: DVec3,
}

/// A component that bends along.
#[derive(Clone, Debug)]
struct Bending {
    vertices: Vec<SurfaceVertex>,
    /// Their rest positions.
    world_rest: Vec<DVec3>,
    /// The first of its ties.
    first_tie: usize,
    /// For each vertex the ties that move it, counted from the first, with their shares, whose sum is 1.
    shares: Vec<[(u16, f64); BLENDED]>,
}

/// The patch that a place of a component follows.
#[derive(Clone, Debug)]
struct Tie {
    /// Vertices of a driven component, or of one that bends along.
    patch: Vec<SurfaceVertex>,
    /// Their rest positions.
    world_rest: Vec<DVec3>,
}

/// The place of a tie, and the radius of its patch.
#[derive(Clone, Copy, Debug)]
struct Place {
    middle: SurfaceVertex,
    radius: f64,
}

/// The number of ties that move a vertex of a component that bends along.
const BLENDED: usize = 4;

/// The most ties of a component that bends along.
const MOST_TIES: usize = 64;

/// If a patch has more vertices, only this many, evenly chosen, are used: a fit needs no more.
const PATCH_SAMPLES: usize = 256;

/// A patch reaches at least this many mean edge lengths at its middle.
const PATCH_EDGES: f64 = 3.0;

/// Ties each of the components `following` to the part that it touches, or else to the nearest of the components
/// `driven`.
///
/// # Errors
/// It was cancelled.
pub(crate) fn followers(
    surface: &Surface,
    topology: &Topology,
    following: &[(u32, Loose)],
    driven: &[u32],
    cancel: &Cancel,
) -> Result<Followers, Cancelled> {
    if following.is_empty() || driven.is_empty() {
        return Ok(Followers::default());
    }
    let nearby = hierarchy(surface, topology, |component| driven.binary_search(&component).is_ok());
    let owners = owners(surface, topology, following, driven, cancel)?;
    let reach = if following.len() > CRUMBS { 0.0 } else { 1.0 };
    let place = |component: u32, middle: SurfaceVertex, radius: f64| Place {
        middle,
        radius: match topology.vertices_of(component).len() {
            // A bare point has no extent, so it moves with the nearest one-ring.
            1 => longest_edge(surface, topology, middle),
            _ => (reach * radius).max(PATCH_EDGES * mean_edge(surface, topology, middle)),
        },
    };
    // A component that follows as a whole needs only its place.
    let rigid: Vec<Option<Place>> = following
        .par_iter()
        .zip(&owners)
        .map(|(&(component, how), owner)| {
            let vertices = topology.vertices_of(component);
            let (middle, radius) = match owner {
                _ if how != Loose::Follow => return None,
                Some(Owner::Follower(_)) => return None,
                Some(Owner::Surface(middle)) => (*middle, half_diagonal(surface, vertices)),
                None => (
                    nearest(surface, vertices.clone(), &nearby)?,
                    half_diagonal(surface, vertices),
                ),
            };
            Some(place(component, middle, radius))
        })
        .collect();
    // Ties on components that bend along come last, because these components have to be moved first.
    let is_on_driven = |place: &Place| driven.binary_search(&topology.component(place.middle)).is_ok();
    let mut places = Places::default();
    let mut ties: Vec<Option<u32>> = vec![None; following.len()];
    let mut followers = Followers::default();
    for (tie, place) in ties.iter_mut().zip(&rigid) {
        *tie = place.filter(is_on_driven).map(|place| places.number(place));
    }
    for &(component, how) in following {
        if how == Loose::Bend
            && let Some((bending, knots)) = bending(surface, topology, component, &nearby, places.list.len())
        {
            places.list.extend(
                knots
                    .into_iter()
                    .map(|(middle, radius)| place(component, middle, radius)),
            );
            followers.bending.push(bending);
        }
    }
    followers.first_on_bending = places.list.len();
    for (tie, place) in ties.iter_mut().zip(&rigid).filter(|(tie, _)| tie.is_none()) {
        *tie = place.map(|place| places.number(place));
    }
    for (index, &(component, how)) in following.iter().enumerate() {
        let Some(tie) = ties[end_of_chain(&owners, index)].filter(|_| how == Loose::Follow) else {
            continue;
        };
        followers
            .rigid
            .extend(topology.vertices_of(component).map(|vertex| Rigid {
                vertex,
                tie,
                world_rest: surface.positions[vertex.index()],
            }));
    }
    cancel.check()?;
    let tie = |place: &Place| tie(surface, topology, place);
    followers.ties = places.list.par_iter().map(tie).collect();
    Ok(followers)
}

/// The places of ties; those of components that follow as a whole are listed once.
#[derive(Default)]
struct Places {
    list: Vec<Place>,
    numbers: BTreeMap<(SurfaceVertex, u64), u32>,
}

impl Places {
    /// The number of a place, which is added if it is new.
    fn number(&mut self, place: Place) -> u32 {
        let key = (place.middle, place.radius.to_bits());
        *self.numbers.entry(key).or_insert_with(|| {
            self.list.push(place);
            self.list.len() as u32 - 1
        })
    }
}

fn positions_of(surface: &Surface, vertices: &[SurfaceVertex]) -> Vec<DVec3> {
    vertices
        .iter()
        .map(|vertex| surface.positions[vertex.index()])
        .collect()
}

/// The vertex of the driven surface nearest to the component of these vertices.
fn nearest(surface: &Surface, vertices: impl Iterator<Item = SurfaceVertex>, nearby: &Bvh) -> Option<SurfaceVertex> {
    let mut nearest: Option<(SurfaceVertex, f64)> = None;
    for point in vertices.map(|vertex| surface.positions[vertex.index()]) {
        if let Some(found) = nearby.nearest_vertex(point)
            && nearest.is_none_or(|(_, distance)| found.1 < distance)
        {
            nearest = Some(found);
        }
    }
    nearest.map(|(middle, _)| middle)
}

/// Half the diagonal of these vertices' bounding box.
fn half_diagonal(surface: &Surface, vertices: impl Iterator<Item = SurfaceVertex>) -> f64 {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for point in vertices.map(|vertex| surface.positions[vertex.index()]) {
        (low, high) = (low.min(point), high.max(point));
    }
    0.5 * low.distance(high)
}

/// A component that bends along, whose ties are the next from `first_tie` on: their middles and radii.
fn bending(
    surface: &Surface,
    topology: &Topology,
    component: u32,
    nearby: &Bvh,
    first_tie: usize,
) -> Option<(Bending, Vec<(SurfaceVertex, f64)>)> {
    let vertices: Vec<SurfaceVertex> = topology.vertices_of(component).collect();
    let world_rest = positions_of(surface, &vertices);
    let (knots, spacing) = spread(&world_rest);
    let place = |&knot: &usize| Some((nearby.nearest_vertex(world_rest[knot])?.0, 0.5 * spacing));
    let places = knots.iter().map(place).collect::<Option<_>>()?;
    let shares = world_rest
        .par_iter()
        .map(|&point| shares_at(point, knots.iter().map(|&knot| world_rest[knot])))
        .collect();
    let bending = Bending {
        vertices,
        world_rest,
        first_tie,
        shares,
    };
    Some((bending, places))
}

/// At most [`MOST_TIES`] of the points, each as far as possible from earlier ones, and the smallest distance between
/// them.
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
            // All of the few ties are blended: there is no fifth.
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

fn tie(surface: &Surface, topology: &Topology, place: &Place) -> Tie {
    let patch = thinned(patch_around(surface, topology, place));
    Tie {
        world_rest: positions_of(surface, &patch),
        patch,
    }
}

/// The mean length of the edges at a vertex.
fn mean_edge(surface: &Surface, topology: &Topology, vertex: SurfaceVertex) -> f64 {
    let centre = surface.positions[vertex.index()];
    let ring = topology.neighbours(vertex);
    let length = |other: &SurfaceVertex| surface.positions[other.index()].distance(centre);
    ring.iter().map(length).sum::<f64>() / ring.len().max(1) as f64
}

/// The length of the longest edge at a vertex.
fn longest_edge(surface: &Surface, topology: &Topology, vertex: SurfaceVertex) -> f64 {
    let centre = surface.positions[vertex.index()];
    let ring = topology.neighbours(vertex).iter();
    ring.map(|other| surface.positions[other.index()].distance(centre))
        .fold(0.0, f64::max)
}

/// The vertices joined to the middle within the radius, in walking order.
fn patch_around(surface: &Surface, topology: &Topology, place: &Place) -> Vec<SurfaceVertex> {
    let centre = surface.positions[place.middle.index()];
    let distance = |vertex: SurfaceVertex| surface.positions[vertex.index()].distance(centre);
    // A table of all vertices per patch would cost more than the patches themselves.
    let mut seen = HashSet::from([place.middle]);
    let mut patch = vec![place.middle];
    let mut next = 0;
    while let Some(&vertex) = patch.get(next) {
        next += 1;
        for &beside in topology.neighbours(vertex) {
            if distance(beside) <= place.radius && seen.insert(beside) {
                patch.push(beside);
            }
        }
    }
    patch
}

fn thinned(patch: Vec<SurfaceVertex>) -> Vec<SurfaceVertex> {
    let stride = patch.len().div_ceil(PATCH_SAMPLES);
    patch.into_iter().step_by(stride.max(1)).collect()
}

impl Followers {
    /// Returns true if nothing follows.
    pub fn is_empty(&self) -> bool {
        self.rigid.is_empty() && self.bending.is_empty()
    }

    /// Writes the followers' displacements, given those of the driven components.
    pub fn carry(&self, displacements: &mut [DVec3]) {
        let motion = |tie: &Tie, displacements: &[DVec3]| {
            let moved: Vec<DVec3> = tie.patch.iter().map(|vertex| displacements[vertex.index()]).collect();
            RigidMotion::fit(&tie.world_rest, &moved)
        };
        let moved =
            |motions: &[Option<RigidMotion>], tie: usize, rest: DVec3| Some(motions.get(tie)?.as_ref()?.displace(rest));
        let (on_driven, on_bending) = self.ties.split_at(self.first_on_bending);
        let mut motions: Vec<Option<RigidMotion>> =
            on_driven.par_iter().map(|tie| motion(tie, displacements)).collect();
        for own in &self.bending {
            for ((vertex, &rest), shares) in own.vertices.iter().zip(&own.world_rest).zip(&own.shares) {
                let shares = shares.iter();
                let parts = shares
                    .filter_map(|&(tie, share)| Some(moved(&motions, own.first_tie + usize::from(tie), rest)? * share));
                if let Some(displacement) = parts.reduce(|sum, more| sum + more) {
                    displacements[vertex.index()] = displacement;
                }
            }
        }
        motions.par_extend(on_bending.par_iter().map(|tie| motion(tie, displacements)));
        for own in &self.rigid {
            if let Some(displacement) = moved(&motions, own.tie as usize, own.world_rest) {
                displacements[own.vertex.index()] = displacement;
            }
        }
    }
}
