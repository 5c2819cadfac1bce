//! The nodes' influence on points, and the joints between nodes.

use glam::DVec3;
use pliant_mesh::{Cancelled, face_area};
use rayon::prelude::*;

use crate::BindError;
use crate::method::BindInput;
use crate::numerical::sums::CHUNKS_A_TASK;
use crate::region::nodes::{NO_NODE, Nodes};
use crate::space::blend::{Share, normalised};
use crate::space::joining::{braces, joins};
use crate::space::neighbours::Neighbours;
use crate::sparse::Elimination;
use crate::sparse::ordering::graph::elimination;

/// Nodes that move a point, and one more, whose distance ends their influence. With the four of [SSP07] the maps follow
/// each other within a narrow seam, and edges across one are stretched.
pub(super) const NEAREST: usize = 8;

/// The distance that ends the influence is a little larger than the last node's, so that some weight is left if all are
/// equally far.
const BEYOND: f64 = 1.0 + 1e-5;

/// The number of vertices whose nodes are found at once.
const AT_ONCE: usize = 1 << 16;

/// The mean over the nodes of the sum of a node's α.
const JOINED: f64 = 6.0;

/// Nodes whose α is below this share are not counted as joined when parts are.
const LOOSE: f64 = 1e-3;

/// Nodes and their joints, in the order of elimination.
#[derive(Debug)]
pub(super) struct Graph {
    pub world_nodes: Vec<DVec3>,
    pub tree: Neighbours,
    pub edges: Vec<Edge>,
    /// ρ: the painted stiffness around each node.
    pub rigidity: Vec<f64>,
    /// The mean distance of joined nodes, in world units.
    pub world_unit: f64,
    /// The end of each supernode of nodes.
    pub ends: Vec<u32>,
}

/// Two nodes that are joined.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Edge {
    /// The lower one first.
    pub nodes: [u32; 2],
    /// α.
    pub weight: f64,
}

impl Graph {
    /// Joins nodes by the influence that they share on the vertices `moving`, weighed by area, and by triangles that
    /// join the parts of the surface nearest to them; `pairs` are further points, in world units, whose nodes will
    /// share an equation.
    pub fn of(input: &BindInput<'_>, nodes: &Nodes, moving: &[u32], pairs: &[DVec3]) -> Result<Self, BindError> {
        let positions = &input.problem.surface.positions;
        let world_nodes: Vec<DVec3> = nodes.vertices.iter().map(|&node| positions[node as usize]).collect();
        let count = world_nodes.len();
        let tree = Neighbours::of(&world_nodes);
        let areas = areas(input, moving);
        let mut sums = Sums::of(count);
        for moving in moving.chunks(AT_ONCE) {
            input.cancel.check()?;
            let rows: Vec<Vec<Share>> = moving
                .par_iter()
                .with_min_len(CHUNKS_A_TASK)
                .map(|&vertex| influence(&tree, &world_nodes, positions[vertex as usize]))
                .collect();
            for (row, &vertex) in rows.iter().zip(moving) {
                let row = row.iter().map(|share| (share.source as usize, share.weight));
                sums.add(row, areas[vertex as usize], input.problem.stiffness[vertex as usize]);
            }
        }
        sums.add_triangles(input, nodes);
        let Sums { shared, around } = sums;
        let rigidity: Vec<f64> = around.iter().map(|[plain, stiff]| stiff / plain).collect();
        let own = |node: usize| shared[node * count + node][0];
        let (mut edges, mut plain) = (Vec::new(), Vec::new());
        for one in 0..count {
            for other in one + 1..count {
                let [bare, stiff] = shared[one * count + other];
                if bare > 0.0 {
                    let size = (own(one) * own(other)).sqrt();
                    plain.push(bare / size);
                    edges.push(Edge {
                        nodes: [one as u32, other as u32],
                        weight: stiff / size,
                    });
                }
            }
        }
        let mean = 2.0 * plain.iter().sum::<f64>() / count.max(1) as f64;
        let scale = if mean > 0.0 { JOINED / mean } else { 1.0 };
        edges.iter_mut().for_each(|edge| edge.weight *= scale);
        let firm: Vec<[u32; 2]> = edges
            .iter()
            .zip(&plain)
            .filter(|(_, plain)| **plain > LOOSE)
            .map(|(edge, _)| edge.nodes)
            .collect();
        let joins = joins(&world_nodes, &firm);
        // The parts may be far apart: their joints are no measure unless there is nothing else.
        let measured = if firm.is_empty() { &joins } else { &firm };
        let length = |&[one, other]: &[u32; 2]| world_nodes[one as usize].distance(world_nodes[other as usize]);
        let world_unit = measured.iter().map(length).sum::<f64>() / measured.len() as f64;
        let braces = braces(&world_nodes, &[&firm[..], &joins].concat());
        for nodes in joins.into_iter().chain(braces) {
            let weight = 0.5 * (rigidity[nodes[0] as usize] + rigidity[nodes[1] as usize]);
            match edges.iter_mut().find(|edge| edge.nodes == nodes) {
                Some(edge) => edge.weight += weight,
                None => edges.push(Edge { nodes, weight }),
            }
        }
        let mut graph = Self {
            world_nodes,
            tree,
            edges,
            rigidity,
            world_unit: if world_unit > 0.0 { world_unit } else { 1.0 },
            ends: Vec::new(),
        };
        graph.reorder(pairs, input)?;
        Ok(graph)
    }

    /// The nodes that move a point, with their weights.
    pub fn influence(&self, world_point: DVec3) -> Vec<Share> {
        influence(&self.tree, &self.world_nodes, world_point)
    }

    /// Renumbers the nodes in an order to eliminate them.
    fn reorder(&mut self, pairs: &[DVec3], input: &BindInput<'_>) -> Result<(), Cancelled> {
        let count = self.world_nodes.len();
        let mut neighbours = vec![Vec::new(); count];
        let mut join = |one: u32, other: u32| {
            neighbours[one as usize].push(other);
            neighbours[other as usize].push(one);
        };
        for edge in &self.edges {
            join(edge.nodes[0], edge.nodes[1]);
        }
        for &point in pairs {
            let row = self.influence(point);
            for (place, one) in row.iter().enumerate() {
                row[..place].iter().for_each(|other| join(one.source, other.source));
            }
        }
        let (mut offsets, mut list) = (vec![0], Vec::new());
        for mut own in neighbours {
            own.sort_unstable();
            own.dedup();
            list.extend(own);
            offsets.push(list.len() as u32);
        }
        let Elimination { order, ends } = elimination(&offsets, &list, input.cancel)?;
        let mut number_of = vec![0; count];
        for (number, &node) in (0..).zip(&order) {
            number_of[node as usize] = number;
        }
        self.world_nodes = order.iter().map(|&node| self.world_nodes[node as usize]).collect();
        self.rigidity = order.iter().map(|&node| self.rigidity[node as usize]).collect();
        self.tree = Neighbours::of(&self.world_nodes);
        for edge in &mut self.edges {
            let [one, other] = edge.nodes.map(|node| number_of[node as usize]);
            edge.nodes = [one.min(other), one.max(other)];
        }
        self.edges.sort_unstable_by_key(|edge| edge.nodes);
        self.ends = ends;
        Ok(())
    }
}

/// The area around each vertex of the surface, in means of those `moving`; 1 for a vertex without area.
fn areas(input: &BindInput<'_>, moving: &[u32]) -> Vec<f64> {
    let surface = input.problem.surface;
    let mut areas = vec![0.0; surface.positions.len()];
    for corners in &surface.triangles {
        let third = face_area(corners.map(|corner| surface.positions[corner.index()])) / 3.0;
        corners.iter().for_each(|corner| areas[corner.index()] += third);
    }
    let mean = moving.iter().map(|&vertex| areas[vertex as usize]).sum::<f64>() / moving.len().max(1) as f64;
    for area in &mut areas {
        *area = if *area > 0.0 && mean > 0.0 { *area / mean } else { 1.0 };
    }
    areas
}

/// The sums that nodes share.
struct Sums {
    /// Σ A w_j w_k over points of the area A, and the same with the stiffness, j not above k.
    shared: Vec<[f64; 2]>,
    /// Σ A w_j, and the same with the stiffness.
    around: Vec<[f64; 2]>,
}

impl Sums {
    /// Empty sums for this many nodes.
    fn of(count: usize) -> Self {
        Self {
            shared: vec![[0.0; 2]; count * count],
            around: vec![[0.0; 2]; count],
        }
    }

    /// Adds a point with the nodes that move it.
    fn add(&mut self, row: impl Iterator<Item = (usize, f64)> + Clone, area: f64, stiffness: f64) {
        let count = self.around.len();
        for (one, weight) in row.clone() {
            let weight = weight * area;
            let own = &mut self.around[one];
            *own = [own[0] + weight, own[1] + weight * stiffness];
            for (other, beside) in row.clone().filter(|(other, _)| *other >= one) {
                let sums = &mut self.shared[one * count + other];
                *sums = [sums[0] + weight * beside, sums[1] + weight * beside * stiffness];
            }
        }
    }

    /// Adds the middle of each edge between the parts of two nodes, which both move alike. Nodes that are nearest in
    /// space may all be of one ring, while the edges lead to the next one.
    fn add_triangles(&mut self, input: &BindInput<'_>, nodes: &Nodes) {
        let (surface, stiffness) = (input.problem.surface, input.problem.stiffness);
        for corners in &surface.triangles {
            for [one, other] in [[0, 1], [1, 2], [2, 0]].map(|ends| ends.map(|end| corners[end].index())) {
                let cells = [one, other].map(|vertex| nodes.cells[vertex]);
                if !cells.contains(&NO_NODE) && cells[0] != cells[1] {
                    let row = cells.map(|cell| (cell as usize, 0.5));
                    self.add(row.into_iter(), 0.5, 0.5 * (stiffness[one] + stiffness[other]));
                }
            }
        }
    }
}

/// (1 − d²/d₈²)² over their sum, with gradients.
fn influence(tree: &Neighbours, world_nodes: &[DVec3], world_point: DVec3) -> Vec<Share> {
    let nearest = tree.nearest(world_point, NEAREST);
    let Some(&(last, most)) = nearest.last() else {
        return Vec::new();
    };
    let from = |node: u32| world_point - world_nodes[node as usize];
    let end = if most > 0.0 { (most * BEYOND).powi(2) } else { 1.0 };
    // The square's number.
    let end_slope = from(last) * (2.0 * BEYOND * BEYOND);
    let raw = |&(node, distance): &(u32, f64)| {
        let share = distance * distance / end;
        let left = 1.0 - share;
        let change = (end_slope * share - from(node) * 2.0) / end;
        (node, left * left, change * (2.0 * left))
    };
    normalised(&nearest.iter().map(raw).collect::<Vec<_>>())
}
