//! Nodes spread over a part of the surface: each new one is the farthest along the surface from earlier ones.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use glam::DVec3;
use pliant_mesh::{SurfaceVertex, Topology};

use super::images::Images;
use crate::numerical::samples::{EQUAL, farthest, thinned};
use crate::region::boundary_problem::BoundaryProblem;

/// Nodes, and the part of the surface nearest to each.
pub(crate) struct Nodes {
    /// Their surface vertices, in the order of their choice.
    pub vertices: Vec<u32>,
    /// For each surface vertex: the number of the nearest node along the surface, or [`NO_NODE`].
    pub cells: Vec<u32>,
}

/// The cell of a vertex that no node reaches.
pub(crate) const NO_NODE: u32 = u32::MAX;

/// If more than this share of the nodes were needed for one in each component, they are spread in space.
const PIECES: f64 = 0.25;

/// Images closer together than this many distances to the nearest node crowd each other.
const APART: f64 = 1.2;

/// Fewer nodes than this are not paired: an even distribution matters more then.
const FEWEST_PAIRED: usize = 200;

/// Sets with more vertices per node than this are thinned before nodes are spread in space.
const CANDIDATES: usize = 100;

/// Like [`spread`]; if the part is its own mirror image and there are enough nodes, they are too.
pub(crate) fn spread_alike(problem: &BoundaryProblem, part: &[u32], most: usize) -> Nodes {
    let images = (most >= FEWEST_PAIRED).then(|| Images::of(&problem.surface.positions, part));
    spread_with(problem, part, most, images.as_ref())
}

/// At most this many nodes among the vertices `part`, which are ascending.
pub(crate) fn spread(problem: &BoundaryProblem, part: &[u32], most: usize) -> Nodes {
    spread_with(problem, part, most, None)
}

fn spread_with(problem: &BoundaryProblem, part: &[u32], most: usize, images: Option<&Images<'_>>) -> Nodes {
    let (positions, topology) = (&problem.surface.positions, problem.topology);
    let mut search = Search::new(positions, topology, part);
    let pieces: BTreeSet<u32> = part.iter().map(|&v| topology.component(SurfaceVertex(v))).collect();
    if pieces.len() as f64 > PIECES * most as f64 {
        let vertices = farthest(&thinned(part, positions, CANDIDATES * most), positions, most);
        vertices.iter().for_each(|&vertex| search.add(vertex));
        return search.nodes;
    }
    let at = |vertex: u32| positions[vertex as usize];
    let Some(&origin) = part.first() else {
        return search.nodes;
    };
    let mean = at(origin) + part.iter().map(|&v| at(v) - at(origin)).sum::<DVec3>() / part.len() as f64;
    while search.nodes.vertices.len() < most {
        let is_first = search.nodes.vertices.is_empty();
        let far = |vertex: u32| match is_first {
            true => at(vertex).distance(mean),
            false => search.distances[vertex as usize],
        };
        let farther = |best: u32, other: u32| match far(other) > far(best) * (1.0 + EQUAL) {
            true => other,
            false => best,
        };
        let next = part.iter().copied().fold(origin, farther);
        if !is_first && search.distances[next as usize] == 0.0 {
            break;
        }
        let apart = if is_first { 0.0 } else { APART * far(next) };
        let is_free = |vertex: u32| search.distances[vertex as usize] > 0.0;
        let next = images.map_or_else(|| vec![next], |images| images.pair(next, apart, is_free));
        if search.nodes.vertices.len() + next.len() > most && !is_first {
            // A single one would lean to its side.
            break;
        }
        next.into_iter().for_each(|vertex| search.add(vertex));
    }
    search.nodes
}

/// Dijkstra's search from one node after another, each within the part to which it is the nearest.
struct Search<'a> {
    positions: &'a [DVec3],
    topology: &'a Topology,
    is_in_part: Vec<bool>,
    distances: Vec<f64>,
    nodes: Nodes,
}

impl<'a> Search<'a> {
    fn new(positions: &'a [DVec3], topology: &'a Topology, part: &[u32]) -> Self {
        let mut is_in_part = vec![false; positions.len()];
        for &vertex in part {
            is_in_part[vertex as usize] = true;
        }
        Self {
            positions,
            topology,
            is_in_part,
            distances: vec![f64::INFINITY; positions.len()],
            nodes: Nodes {
                vertices: Vec::new(),
                cells: vec![NO_NODE; positions.len()],
            },
        }
    }

    fn add(&mut self, node: u32) {
        let number = self.nodes.vertices.len() as u32;
        self.nodes.vertices.push(node);
        let mut queue = BinaryHeap::from([(Reverse(Key(0.0)), node)]);
        self.distances[node as usize] = 0.0;
        self.nodes.cells[node as usize] = number;
        while let Some((Reverse(Key(distance)), vertex)) = queue.pop() {
            if distance > self.distances[vertex as usize] {
                continue;
            }
            let at = self.positions[vertex as usize];
            for &SurfaceVertex(other) in self.topology.neighbours(SurfaceVertex(vertex)) {
                let way = distance + at.distance(self.positions[other as usize]);
                // The first of equally near nodes gets a vertex, even if rounding makes a difference.
                let is_nearer = way < self.distances[other as usize] * (1.0 - EQUAL);
                if self.is_in_part[other as usize] && is_nearer {
                    self.distances[other as usize] = way;
                    self.nodes.cells[other as usize] = number;
                    queue.push((Reverse(Key(way)), other));
                }
            }
        }
    }
}

/// A distance with a total order.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Key(f64);

impl Eq for Key {}

impl Ord for Key {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
