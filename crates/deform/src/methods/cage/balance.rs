//! The discrete Laplace equation on a grid inside the cage.
//!
//! A node's balance is Σ (u_neighbour − u) / θ = 0 over its six directions. θ is the distance in steps to the next node
//! or, if the cage comes first, to the cage, which gives the value there [GFCK02]. All difference quotients of a linear
//! function are alike, so linear functions are reproduced exactly, and the matrix is such that no coordinate is
//! negative.

use glam::USizeVec3;

use super::crossings::{Crossings, GridFrame};
use super::mesh::CageMesh;
use crate::sparse::matrix::ScaledMatrix;

/// The number of coordinates that one solve handles.
pub(super) const AT_ONCE: usize = 8;

/// The number of a node outside the cage.
pub(super) const OUTSIDE: u32 = u32::MAX;

/// The equations of all nodes' balances.
pub(super) struct Balance {
    /// The weight of each node: the sum of all weights around it.
    diagonal: Vec<f64>,
    pub offsets: Vec<u32>,
    /// The nodes beside each, in compressed rows.
    pub neighbours: Vec<u32>,
    /// For each eight vertices: node, vertex among the eight, and the weight of its value on the cage.
    pub on_cage: Vec<Vec<(u32, usize, f64)>>,
}

impl Balance {
    /// Makes the balance at each of the nodes that `inside` numbers.
    pub fn of(cage: &CageMesh, frame: &GridFrame, crossings: &Crossings, inside: &[u32], node_count: usize) -> Self {
        /// At a smaller distance from the cage, a node has the cage's value to all digits.
        const NEAREST: f64 = 1e-9;
        let mut balance = Self {
            diagonal: Vec::with_capacity(node_count),
            offsets: vec![0],
            neighbours: Vec::new(),
            on_cage: vec![Vec::new(); cage.vertices.len().div_ceil(AT_ONCE)],
        };
        for node in nodes(frame).filter(|node| inside[frame.number(*node)] != OUTSIDE) {
            let own = inside[frame.number(node)];
            let mut diagonal = 0.0;
            for axis in 0..3 {
                let line = crossings.along(frame, axis, node);
                let here = node[axis] as f64;
                let ahead = line.partition_point(|crossing| crossing.at < here);
                let met = [ahead.checked_sub(1).map(|place| &line[place]), line.get(ahead)];
                for (met, is_ahead) in met.into_iter().zip([false, true]) {
                    if let Some(crossing) = met.filter(|crossing| (crossing.at - here).abs() <= 1.0) {
                        let weight = (crossing.at - here).abs().max(NEAREST).recip();
                        diagonal += weight;
                        for (vertex, share) in cage.faces[crossing.face as usize].iter().zip(crossing.barycentric) {
                            let vertex = *vertex as usize;
                            balance.on_cage[vertex / AT_ONCE].push((own, vertex % AT_ONCE, weight * share.max(0.0)));
                        }
                        continue;
                    }
                    let mut next = node;
                    next[axis] = if is_ahead { node[axis] + 1 } else { node[axis] - 1 };
                    let other = inside[frame.number(next)];
                    if other != OUTSIDE {
                        diagonal += 1.0;
                        balance.neighbours.push(other);
                    }
                }
            }
            balance.diagonal.push(diagonal);
            let start = balance.offsets[balance.offsets.len() - 1] as usize;
            balance.neighbours[start..].sort_unstable();
            balance.offsets.push(balance.neighbours.len() as u32);
        }
        balance
    }
}

/// Numbers the nodes inside: the line along x crosses the cage an odd number of times before each.
pub(super) fn nodes_inside(frame: &GridFrame, crossings: &Crossings) -> Vec<u32> {
    let mut inside = vec![OUTSIDE; frame.count()];
    let mut count = 0;
    for node in nodes(frame) {
        let before = crossings.along(frame, 0, node).iter();
        if before.filter(|crossing| crossing.at < node.x as f64).count() % 2 == 1 {
            inside[frame.number(node)] = count;
            count += 1;
        }
    }
    inside
}

fn nodes(frame: &GridFrame) -> impl Iterator<Item = USizeVec3> + use<> {
    let counts = frame.counts;
    let row = move |y, z| (0..counts.x).map(move |x| USizeVec3::new(x, y, z));
    (0..counts.z).flat_map(move |z| (0..counts.y).flat_map(move |y| row(y, z)))
}

/// The balances' matrix in the order of elimination.
pub(super) fn matrix(balance: &Balance, order: &[u32], column_of: &[u32]) -> ScaledMatrix {
    let mut matrix = ScaledMatrix {
        scale: order
            .iter()
            .map(|&node| balance.diagonal[node as usize].sqrt().recip())
            .collect(),
        lower_offsets: vec![0],
        lower_rows: Vec::new(),
        lower_values: Vec::new(),
    };
    for (column, &node) in order.iter().enumerate() {
        let node = node as usize;
        let neighbours = &balance.neighbours[balance.offsets[node] as usize..balance.offsets[node + 1] as usize];
        let mut rows: Vec<u32> = neighbours.iter().map(|&other| column_of[other as usize]).collect();
        rows.retain(|&row| row as usize > column);
        rows.sort_unstable();
        matrix.lower_rows.push(column as u32);
        matrix.lower_values.push(balance.diagonal[node]);
        matrix.lower_values.extend(rows.iter().map(|_| -1.0));
        matrix.lower_rows.extend(rows);
        matrix.lower_offsets.push(matrix.lower_rows.len() as u32);
    }
    matrix.scale_values();
    matrix
}
