//! The nodes' influence on points, and which nodes are joined.

use glam::DVec3;
use pliant_mesh::Cancelled;
use rayon::prelude::*;

use crate::BindError;
use crate::method::BindInput;
use crate::numerical::sums::CHUNKS_A_TASK;
use crate::space::blend::{Share, normalised};
use crate::space::joining::joins;
use crate::space::neighbours::Neighbours;
use crate::sparse::Elimination;
use crate::sparse::ordering::graph::elimination;

/// Nodes that move a point, and one more, whose distance ends their influence.
const NEAREST: usize = 5;

/// The distance that ends the influence is a little larger than the fifth node's, so that some weight is left where
/// all five are equally far.
const BEYOND: f64 = 1.0 + 1e-5;

/// The mean over the nodes of the sum of a node's α.
const JOINED: f64 = 6.0;

/// Nodes whose α is below this share are not counted as joined when parts are.
const LOOSE: f64 = 1e-3;

/// Nodes and what joins them, in the order of elimination.
#[derive(Debug)]
pub(super) struct Graph {
    pub world_nodes: Vec<DVec3>,
    pub tree: Neighbours,
    pub edges: Vec<Edge>,
    /// ρ: the painted stiffness around each node.
    pub rigidity: Vec<f64>,
    /// The mean distance of joined nodes, in world units.
    pub world_unit: f64,
    /// Where each supernode of nodes ends.
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
    /// Joins nodes at these vertices by the influence that they share on the vertices `moving`; `pairs` are further
    /// points, in world units, whose nodes will share an equation.
    pub fn of(input: &BindInput<'_>, nodes: &[u32], moving: &[u32], pairs: &[DVec3]) -> Result<Self, BindError> {
        let positions = &input.problem.surface.positions;
        let world_nodes: Vec<DVec3> = nodes.iter().map(|&node| positions[node as usize]).collect();
        let count = nodes.len();
        let tree = Neighbours::of(&world_nodes);
        let rows: Vec<Vec<Share>> = moving
            .par_iter()
            .with_min_len(CHUNKS_A_TASK)
            .map(|&vertex| influence(&tree, &world_nodes, positions[vertex as usize]))
            .collect();
        input.cancel.check()?;
        // Σ w_j w_k, and the same with the stiffness.
        let mut shared = vec![[0.0; 2]; count * count];
        let mut around = vec![[0.0; 2]; count];
        for (row, &vertex) in rows.iter().zip(moving) {
            let stiffness = input.problem.stiffness[vertex as usize];
            for one in row {
                around[one.source as usize][0] += one.weight;
                around[one.source as usize][1] += one.weight * stiffness;
                for other in row.iter().filter(|other| other.source >= one.source) {
                    let sums = &mut shared[one.source as usize * count + other.source as usize];
                    sums[0] += one.weight * other.weight;
                    sums[1] += one.weight * other.weight * stiffness;
                }
            }
        }
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
        let lengths = firm.iter().chain(&joins);
        let lengths = lengths.map(|&[one, other]| world_nodes[one as usize].distance(world_nodes[other as usize]));
        let world_unit = lengths.sum::<f64>() / (firm.len() + joins.len()) as f64;
        for nodes in joins {
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

/// (1 − d²/d₅²)² over their sum, with gradients.
fn influence(tree: &Neighbours, world_nodes: &[DVec3], world_point: DVec3) -> Vec<Share> {
    let nearest = tree.nearest(world_point, NEAREST);
    let Some(&(last, most)) = nearest.last() else {
        return Vec::new();
    };
    let from = |node: u32| world_point - world_nodes[node as usize];
    let end = if most > 0.0 { (most * BEYOND).powi(2) } else { 1.0 };
    // Of the square's.
    let end_slope = from(last) * (2.0 * BEYOND * BEYOND);
    let raw = |&(node, distance): &(u32, f64)| {
        let share = distance * distance / end;
        let left = 1.0 - share;
        let change = (end_slope * share - from(node) * 2.0) / end;
        (node, left * left, change * (2.0 * left))
    };
    normalised(&nearest.iter().map(raw).collect::<Vec<_>>())
}
