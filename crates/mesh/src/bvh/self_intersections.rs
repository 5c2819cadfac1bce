//! Places where a surface passes through itself: pairs of triangles by their boxes, then by their corners.

use std::collections::BTreeMap;

use glam::DVec3;
use rayon::prelude::*;

use super::boxes::Span;
use super::{Bvh, Node};
use crate::geometry::triangle_intersection;
use crate::topology::components::roots;
use crate::{Cancel, Cancelled, Progress, Surface, SurfaceVertex, Topology};

/// Two triangles that pass through each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfIntersection {
    /// Their corners.
    pub triangles: [[SurfaceVertex; 3]; 2],
    /// The segment in which they pass through each other.
    pub segment: [DVec3; 2],
}

/// The result of a search.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SelfIntersections {
    /// The pairs, in the order of the hierarchy.
    pub pairs: Vec<SelfIntersection>,
    /// True if these are all pairs.
    pub are_all: bool,
}

impl SelfIntersections {
    /// The numbers of the pairs, grouped by place: pairs that are connected by corners are at one place. Places are in
    /// the order of their first pairs.
    pub fn places(&self) -> Vec<Vec<usize>> {
        let mut corners: Vec<SurfaceVertex> = self.pairs.iter().flat_map(SelfIntersection::corners).collect();
        corners.sort_unstable();
        corners.dedup();
        let number = |corner: SurfaceVertex| corners.partition_point(|&other| other < corner) as u32;
        let edges = self.pairs.iter().flat_map(|pair| {
            let first = pair.triangles[0][0];
            pair.corners().map(move |other| [first, other].map(number))
        });
        let roots = roots(corners.len(), edges);
        let mut place_of_root = BTreeMap::new();
        let mut places: Vec<Vec<usize>> = Vec::new();
        for (number_of_pair, pair) in self.pairs.iter().enumerate() {
            let root = roots[number(pair.triangles[0][0]) as usize];
            let place = *place_of_root.entry(root).or_insert(places.len());
            if place == places.len() {
                places.push(Vec::new());
            }
            places[place].push(number_of_pair);
        }
        places
    }
}

impl SelfIntersection {
    fn corners(&self) -> impl Iterator<Item = SurfaceVertex> + use<> {
        self.triangles.into_iter().flatten()
    }
}

/// The number of leaves searched between two checks whether to go on: a few at first, because if everything overlaps
/// each leaf has as many pairs as there are triangles.
const FIRST_LEAVES: usize = 8;
const MOST_LEAVES: usize = 512;

/// Deciding whether a crossing is new costs as much as this many pairs.
const PAIRS_A_CROSSING: usize = 50;

/// The number of pairs tried for each triangle before the search ends: a surface has some twenty with boxes that
/// overlap, and a tangle has as many as there are triangles.
const TRIED_A_TRIANGLE: usize = 400;

/// At most this many of the triangles around a corner count as next to it. Few corners have more than ten.
const NEXT: usize = 32;

impl Bvh {
    /// The pairs of triangles that pass through each other in the hierarchy's positions and did not at rest. The rest
    /// shape is `surface`; the hierarchy has all or some of its triangles. The search ends at `most` pairs, or when it
    /// has become as long as only a tangle makes it.
    ///
    /// If the triangles next to a pair crossed at rest, the same crossing has only shifted, and the pair does not
    /// count. Nor does a pair with a triangle that is joined to no other, as in a soup: it bounds nothing, and soups
    /// cross themselves anyway. Pairs of triangles that did not move are skipped, so the cost of a local change is that
    /// of its own triangles.
    ///
    /// # Errors
    /// [`Cancelled`] soon after `cancel` is raised.
    pub fn new_self_intersections(
        &self,
        surface: &Surface,
        topology: &Topology,
        most: usize,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<SelfIntersections, Cancelled> {
        let is_elsewhere = |v: &SurfaceVertex| self.positions.get(v.index()) != surface.positions[v.index()];
        let is_moved = self.marked_nodes(|corners| corners.iter().any(is_elsewhere));
        let is_loose = |corners: [SurfaceVertex; 3]| {
            let mut corners = corners.into_iter();
            corners.all(|v| topology.faces(v, &surface.triangles).nth(1).is_none())
        };
        let is_new = |pair: &SelfIntersection| {
            !pair.triangles.into_iter().any(is_loose) && !crossed_at_rest(pair, surface, topology)
        };
        self.search(&is_moved, is_new, most, progress, cancel)
    }

    /// The pairs of triangles that pass through each other of which at least one `is_chosen` by its corners. The search
    /// ends as that for new ones does.
    ///
    /// # Errors
    /// [`Cancelled`] soon after `cancel` is raised.
    pub fn self_intersections_of(
        &self,
        is_chosen: impl Fn([SurfaceVertex; 3]) -> bool + Sync,
        most: usize,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<SelfIntersections, Cancelled> {
        let is_marked = self.marked_nodes(|corners| is_chosen(*corners));
        let is_wanted = |pair: &SelfIntersection| pair.triangles.into_iter().any(&is_chosen);
        self.search(&is_marked, is_wanted, most, progress, cancel)
    }

    /// The wanted pairs that have a triangle below a marked leaf.
    fn search(
        &self,
        is_marked: &[bool],
        is_wanted: impl Fn(&SelfIntersection) -> bool + Sync,
        most: usize,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<SelfIntersections, Cancelled> {
        let leaves: Vec<u32> = (0..self.nodes.len() as u32)
            .filter(|&place| is_marked[place as usize] && self.nodes.get(place as usize).count > 0)
            .collect();
        let (mut pairs, mut tried) = (Vec::new(), 0);
        let most_tried = TRIED_A_TRIANGLE * self.leaves.triangles.len();
        let mut are_all = true;
        let (mut rest, mut count) = (&leaves[..], FIRST_LEAVES);
        while !rest.is_empty() {
            cancel.check()?;
            progress.set(1.0 - rest.len() as f32 / leaves.len() as f32);
            let (some, others) = rest.split_at(count.min(rest.len()));
            (rest, count) = (others, (2 * count).min(MOST_LEAVES));
            if pairs.len() > most || tried > most_tried {
                are_all = false;
                break;
            }
            let of_leaf = |&leaf: &u32| {
                let (mut found, tried) = self.pairs_of(leaf, is_marked);
                let tried = tried + PAIRS_A_CROSSING * found.len();
                found.retain(&is_wanted);
                (found, tried)
            };
            for (found, of_leaf) in some.par_iter().map(of_leaf).collect::<Vec<_>>() {
                pairs.extend(found);
                tried += of_leaf;
            }
        }
        are_all &= pairs.len() <= most;
        pairs.truncate(most);
        Ok(SelfIntersections { pairs, are_all })
    }

    /// For each node, whether a triangle below it is marked.
    fn marked_nodes(&self, is_marked: impl Fn(&[SurfaceVertex; 3]) -> bool + Sync) -> Vec<bool> {
        let of_leaf = |place: usize| {
            let leaf = self.nodes.get(place).leaf();
            leaf.is_some_and(|leaf| self.leaves.corners[leaf].iter().any(&is_marked))
        };
        let mut is_moved: Vec<bool> = (0..self.nodes.len()).into_par_iter().map(of_leaf).collect();
        // Children come after their parents.
        for place in (0..self.nodes.len()).rev() {
            let Node { first, count, .. } = self.nodes.get(place);
            if count == 0 {
                is_moved[place] = is_moved[first as usize] || is_moved[first as usize + 1];
            }
        }
        is_moved
    }

    /// The pairs of a moved leaf: within it, with leaves that did not move, and with moved leaves after it; and the
    /// number of pairs that were tried.
    fn pairs_of(&self, leaf: u32, is_moved: &[bool]) -> (Vec<SelfIntersection>, usize) {
        let own = self.nodes.get(leaf as usize);
        let places = own.leaf().unwrap_or_default();
        let (mut found, mut tried) = (Vec::new(), 0);
        for first in places.clone() {
            found.extend((first + 1..places.end).filter_map(|second| self.intersection(first, second)));
        }
        let mut stack = vec![0_u32];
        while let Some(number) = stack.pop() {
            let other = self.nodes.get(number as usize);
            if !overlap(&own.span, &other.span) {
                continue;
            }
            let Some(others) = other.leaf() else {
                stack.extend([other.first + 1, other.first]);
                continue;
            };
            if number > leaf || (number < leaf && !is_moved[number as usize]) {
                tried += places.len() * others.len();
                let pairs = places.clone().flat_map(|a| others.clone().map(move |b| (a, b)));
                found.extend(pairs.filter_map(|(a, b)| self.intersection(a, b)));
            }
        }
        (found, tried)
    }

    fn intersection(&self, a: usize, b: usize) -> Option<SelfIntersection> {
        let triangles = [a, b].map(|place| self.leaves.corners[place]);
        let [a, b] = triangles.map(|corners| corners.map(|v| self.positions.get(v.index())));
        Some(SelfIntersection {
            triangles,
            segment: triangle_intersection(a, b)?,
        })
    }
}

fn overlap(a: &Span, b: &Span) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}

/// Returns true if a triangle at or next to the first of a pair passes through one at or next to the second at rest.
fn crossed_at_rest(pair: &SelfIntersection, surface: &Surface, topology: &Topology) -> bool {
    let [first, second] = pair.triangles;
    let at_rest = |triangle: [SurfaceVertex; 3]| triangle.map(|v| surface.positions[v.index()]);
    if triangle_intersection(at_rest(first), at_rest(second)).is_some() {
        return true;
    }
    let around = |triangle: [SurfaceVertex; 3]| -> Vec<[DVec3; 3]> {
        let faces = triangle
            .into_iter()
            .flat_map(|v| topology.faces(v, &surface.triangles).take(NEXT));
        let mut faces: Vec<u32> = faces.collect();
        faces.sort_unstable();
        faces.dedup();
        faces
            .iter()
            .map(|&face| at_rest(surface.triangles[face as usize]))
            .collect()
    };
    let others = around(second);
    around(first)
        .iter()
        .any(|own| others.iter().any(|other| triangle_intersection(*own, *other).is_some()))
}

#[cfg(test)]
#[path = "self_intersections_tests.rs"]
mod tests;
