//! Nodes spread over the part that moves: each new one the farthest along the surface from those before.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use glam::DVec3;
use pliant_mesh::SurfaceVertex;

use crate::method::BindInput;
use crate::space::samples::{EQUAL, farthest, thinned};

/// If more than this share of the nodes were needed for one in each component, they are spread in space.
const PIECES: f64 = 0.25;

/// Sets with more vertices than so many a node are thinned before nodes are spread in space.
const CANDIDATES: usize = 100;

/// At most so many of the vertices `moving`, which are ascending.
pub(super) fn spread(input: &BindInput<'_>, moving: &[u32], most: usize) -> Vec<u32> {
    let (positions, topology) = (&input.problem.surface.positions, input.problem.topology);
    let pieces: BTreeSet<u32> = moving.iter().map(|&v| topology.component(SurfaceVertex(v))).collect();
    if pieces.len() as f64 > PIECES * most as f64 {
        return farthest(&thinned(moving, positions, CANDIDATES * most), positions, most);
    }
    let mut is_moving = vec![false; positions.len()];
    for &vertex in moving {
        is_moving[vertex as usize] = true;
    }
    let at = |vertex: u32| positions[vertex as usize];
    let Some(&origin) = moving.first() else {
        return Vec::new();
    };
    let mean = at(origin) + moving.iter().map(|&v| at(v) - at(origin)).sum::<DVec3>() / moving.len() as f64;
    let mut distances = vec![f64::INFINITY; positions.len()];
    let mut nodes: Vec<u32> = Vec::new();
    while nodes.len() < most {
        let far = |vertex: u32| match nodes.is_empty() {
            true => at(vertex).distance(mean),
            false => distances[vertex as usize],
        };
        let farther = |best: u32, other: u32| match far(other) > far(best) * (1.0 + EQUAL) {
            true => other,
            false => best,
        };
        let next = moving.iter().copied().fold(origin, farther);
        if !nodes.is_empty() && distances[next as usize] == 0.0 {
            break;
        }
        nodes.push(next);
        // Dijkstra's search from the new node, as far as it is the nearest.
        let mut queue = BinaryHeap::from([(Reverse(Key(0.0)), next)]);
        distances[next as usize] = 0.0;
        while let Some((Reverse(Key(distance)), vertex)) = queue.pop() {
            if distance > distances[vertex as usize] {
                continue;
            }
            for &SurfaceVertex(other) in topology.neighbours(SurfaceVertex(vertex)) {
                let way = distance + at(vertex).distance(at(other));
                if is_moving[other as usize] && way < distances[other as usize] {
                    distances[other as usize] = way;
                    queue.push((Reverse(Key(way)), other));
                }
            }
        }
    }
    nodes
}

/// A distance in the order of numbers.
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
