//! The strain of the coarse shape: the relative changes of the lengths of edges between samples of the surface, and the
//! edges that give a vertex's strain [BLB+08, section 4].
//!
//! f_e = l_e / l̄_e − 1, the bar marking the rest shape. The edges join samples with touching cells, which are the
//! parts of the surface nearest to them. A vertex i measures the distance of two strains by the edges whose middles are
//! nearest,
//!
//! |f − g|_i² = Σ_e α_ie (f_e − g_e)²,   Σ_e α_ie = 1,
//!
//! with α_ie ~ (1 − d²/D²)², d being the distance of the edge's middle and D that of the first edge that is left out.
//! So α is continuous over the surface, and a strain far away has no effect. Bickel et al. let it fall off
//! exponentially, which never ends.

use std::collections::BTreeSet;

use glam::DVec3;
use pliant_mesh::SurfaceVertex;
use rayon::prelude::*;

use crate::numerical::rows::CHUNK;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::nodes::{NO_NODE, spread};
use crate::region::patch::Patch;
use crate::space::neighbours::Neighbours;

/// The edges between samples.
#[derive(Debug)]
pub(super) struct Strain {
    edges: Vec<Edge>,
    /// The nearest edges of each row with their shares α, `per_row` of them.
    near: Vec<(u32, f32)>,
    per_row: usize,
}

/// An edge between two samples.
#[derive(Debug)]
struct Edge {
    /// Surface vertices.
    ends: [u32; 2],
    /// Their rest positions.
    rest: [DVec3; 2],
    length: f64,
}

/// The number of edges that give a vertex's strain.
const NEAREST: usize = 16;

/// Edges that are shorter than this share of the model's diagonal are left out.
const SHORTEST: f64 = 1e-6;

impl Strain {
    /// The edges between at most this many samples of a patch.
    pub fn of(problem: &BoundaryProblem, patch: &Patch, samples: usize) -> Self {
        let positions = &problem.surface.positions;
        let nodes = spread(problem, &patch.vertices, samples);
        let cell = |vertex: u32| nodes.cells[vertex as usize];
        let mut joined = BTreeSet::new();
        for &vertex in &patch.vertices {
            for &SurfaceVertex(other) in problem.topology.neighbours(SurfaceVertex(vertex)) {
                let (own, next) = (cell(vertex), cell(other));
                if own < next && next != NO_NODE {
                    joined.insert([own, next]);
                }
            }
        }
        let edge = |pair: &[u32; 2]| {
            let ends = pair.map(|node| nodes.vertices[node as usize]);
            let rest = ends.map(|vertex| positions[vertex as usize]);
            Edge {
                ends,
                rest,
                length: rest[0].distance(rest[1]),
            }
        };
        let edges: Vec<Edge> = joined
            .iter()
            .map(edge)
            .filter(|edge| edge.length > SHORTEST * patch.size)
            .collect();
        let middles: Vec<DVec3> = edges.iter().map(|edge| edge.rest[0].midpoint(edge.rest[1])).collect();
        let tree = Neighbours::of(&middles);
        let per_row = edges.len().min(NEAREST);
        let near = |row: usize| shares(&tree, patch.rest[patch.rows[row] as usize], per_row);
        let rows: Vec<Vec<(u32, f32)>> = (0..patch.rows.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(near)
            .collect();
        Self {
            edges,
            near: rows.concat(),
            per_row,
        }
    }

    /// The number of edges.
    pub fn len(&self) -> usize {
        self.edges.len()
    }

    /// Fills `changes` with f_e of each edge: 0 to the last bit at rest.
    pub fn measure(&self, displacements: &[DVec3], changes: &mut Vec<f64>) {
        changes.clear();
        changes.extend(self.edges.iter().map(|edge| {
            let [a, b] = edge.ends.map(|vertex| displacements[vertex as usize]);
            (edge.rest[0] + a).distance(edge.rest[1] + b) / edge.length - 1.0
        }));
    }

    /// |f − g|_i at a row, f and g given by their numbers at each edge.
    #[inline]
    pub fn distance(&self, row: usize, difference: impl Fn(usize) -> f64) -> f64 {
        let near = &self.near[row * self.per_row..][..self.per_row];
        let square = near
            .iter()
            .map(|&(edge, share)| f64::from(share) * difference(edge as usize).powi(2));
        square.sum::<f64>().sqrt()
    }
}

/// The nearest edges of a point with their shares.
fn shares(tree: &Neighbours, at: DVec3, count: usize) -> Vec<(u32, f32)> {
    let nearest = tree.nearest(at, count + 1);
    let limit = match nearest.get(count) {
        Some((_, distance)) => *distance,
        None => 1.5 * nearest.last().map_or(0.0, |(_, distance)| *distance),
    };
    // All of them have some weight, so that at least one always counts.
    let share = |distance: f64| (1.0 - (distance / limit).powi(2)).max(1e-3).powi(2);
    let sum: f64 = nearest.iter().take(count).map(|(_, distance)| share(*distance)).sum();
    let nearest = nearest.iter().take(count);
    nearest
        .map(|&(edge, distance)| (edge, (share(distance) / sum) as f32))
        .collect()
}
