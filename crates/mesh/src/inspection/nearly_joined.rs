//! Borders that run beside each other at a small share of their edges' length, like an unintended cut.

use glam::DVec3;

use crate::topology::rings::TopologyFindings;
use crate::weld::nearby::with_neighbours;
use crate::{Surface, SurfaceVertex};

/// Vertices on borders are nearly joined within this share of the shortest border edge at either of them.
const NEARLY: f64 = 0.05;

/// The vertices on borders that are close to others to which they are not joined, ascending. Both ends of a border edge
/// must be close: single vertices touch in sound meshes as well.
pub(super) fn nearly_joined(surface: &Surface, found: &TopologyFindings) -> Vec<SurfaceVertex> {
    let mut vertices: Vec<SurfaceVertex> = found.boundary.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    let local = |v: SurfaceVertex| vertices.binary_search(&v).unwrap_or_default();
    let position = |v: SurfaceVertex| surface.positions[v.index()];
    let mut reach = vec![f64::INFINITY; vertices.len()];
    for &[a, b] in &found.boundary {
        let length = NEARLY * position(a).distance(position(b));
        for v in [a, b] {
            let reach = &mut reach[local(v)];
            *reach = reach.min(length);
        }
    }
    let positions: Vec<DVec3> = vertices.iter().map(|&v| position(v)).collect();
    let mut is_near = vec![false; vertices.len()];
    for near in with_neighbours(&positions, |place| reach[place as usize]) {
        is_near[near as usize] = true;
    }
    let edges = found
        .boundary
        .iter()
        .filter(|edge| edge.iter().all(|&v| is_near[local(v)]));
    let mut nearly: Vec<SurfaceVertex> = edges.flatten().copied().collect();
    nearly.sort_unstable();
    nearly.dedup();
    nearly
}
