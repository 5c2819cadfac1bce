//! Harmonic coordinates [JMD+07]: each vertex' function is harmonic inside the cage and, on it, the hat function of the
//! vertex.
//!
//! A grid inside the cage gives them (`balance`). Between the nodes cubic B-splines with their values as coefficients
//! keep linear functions and signs and have continuous curvature.

use glam::{DVec3, I64Vec3};
use pliant_mesh::{Cancel, Progress};
use rayon::prelude::*;

use super::balance::{AT_ONCE, Balance, OUTSIDE, matrix, nodes_inside};
use super::crossings::{Crossings, GridFrame};
use super::mesh::CageMesh;
use crate::budget::{Budget, bytes_of, filled};
use crate::sparse::cholesky::Factor;
use crate::sparse::factor_error::FactorError;
use crate::sparse::ordering::graph::elimination;

/// The coordinates at the nodes inside a cage.
#[derive(Debug)]
pub(super) struct Harmonic {
    frame: GridFrame,
    /// For each node of the grid its number among those inside.
    inside: Vec<u32>,
    node_count: usize,
    vertex_count: usize,
    /// For each eight vertices their coordinates at the nodes.
    values: Vec<Vec<[f64; AT_ONCE]>>,
}

impl Harmonic {
    /// Solves on a grid of this step.
    ///
    /// # Errors
    /// It was cancelled, or takes more than the budget.
    pub fn solved(
        cage: &CageMesh,
        step: f64,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, FactorError> {
        let frame = GridFrame::around(cage, step);
        let vertex_count = cage.vertices.len();
        let blocks = vertex_count.div_ceil(AT_ONCE);
        // The nodes of the grid and their tables; the rest grows with the nodes inside.
        let budget = budget.without(bytes_of(frame.count(), 16))?;
        let crossings = Crossings::of(cage, &frame);
        let inside = nodes_inside(&frame, &crossings);
        let node_count = inside.iter().filter(|node| **node != OUTSIDE).count();
        let budget = budget.without(bytes_of(node_count, 8 * AT_ONCE * (blocks + 4) + 200))?;
        let balance = Balance::of(cage, &frame, &crossings, &inside, node_count);
        let order = elimination(&balance.offsets, &balance.neighbours, cancel).map_err(|_| FactorError::Cancelled)?;
        progress.set(0.2);
        let mut column_of = vec![0_u32; node_count];
        for (column, &node) in order.order.iter().enumerate() {
            column_of[node as usize] = column as u32;
        }
        let matrix = matrix(&balance, &order.order, &column_of);
        let mut factor = Factor::analysed(&matrix, &order.ends, budget)?;
        factor.fill(&matrix, 0.0, cancel)?;
        progress.set(0.5);
        let solve = |on_cage: &Vec<(u32, usize, f64)>| {
            if cancel.is_cancelled() {
                return Err(FactorError::Cancelled);
            }
            let mut x = filled([0.0; AT_ONCE], node_count)?;
            for &(node, place, weight) in on_cage {
                x[column_of[node as usize] as usize][place] += weight;
            }
            let rescale = |x: &mut [[f64; AT_ONCE]]| {
                for (x, scale) in x.iter_mut().zip(&matrix.scale) {
                    *x = x.map(|value| value * scale);
                }
            };
            rescale(&mut x);
            factor.solve(&mut x);
            rescale(&mut x);
            let mut values = filled([0.0; AT_ONCE], node_count)?;
            for (column, &node) in order.order.iter().enumerate() {
                values[node as usize] = x[column];
            }
            Ok(values)
        };
        let values = balance.on_cage.par_iter().map(solve).collect::<Result<Vec<_>, _>>()?;
        progress.set(1.0);
        Ok(Self {
            frame,
            inside,
            node_count,
            vertex_count,
            values,
        })
    }

    /// The number of nodes in the cage.
    pub fn node_count(&self) -> usize {
        self.node_count
    }

    /// The number of nodes in the cage among the 64 that give a point's coordinates.
    pub fn nodes_around(&self, point: DVec3) -> usize {
        let first = self.frame.steps(point).floor().as_i64vec3() - 1;
        let around = (0..64).map(|step| first + I64Vec3::new(step % 4, step / 4 % 4, step / 16));
        around.filter(|node| self.node(*node).is_some()).count()
    }

    /// A node's coordinate of a vertex.
    pub fn value(&self, node: usize, vertex: usize) -> f64 {
        self.values[vertex / AT_ONCE][node][vertex % AT_ONCE]
    }

    /// The coordinates of a point in the cage.
    pub fn at(&self, point: DVec3) -> Vec<f64> {
        let mut all = vec![0.0; self.vertex_count];
        self.weights(point, |node, weight, _| {
            for (vertex, value) in all.iter_mut().enumerate() {
                *value += weight * self.value(node, vertex);
            }
        });
        all
    }

    /// Visits the nodes around a point: number, weight, and the weight's gradient. The weights sum to 1.
    pub fn weights(&self, point: DVec3, mut visit: impl FnMut(usize, f64, DVec3)) {
        let steps = self.frame.steps(point);
        let first = steps.floor().as_i64vec3() - 1;
        let [x, y, z] = [0, 1, 2].map(|axis| cubic(steps[axis] - steps[axis].floor()));
        let mut found = [(0, 0.0, DVec3::ZERO); 64];
        let mut count = 0;
        for k in 0..4 {
            for j in 0..4 {
                for i in 0..4 {
                    let Some(node) = self.node(first + I64Vec3::new(i as i64, j as i64, k as i64)) else {
                        continue;
                    };
                    let gradient = DVec3::new(
                        x[i].1 * y[j].0 * z[k].0,
                        x[i].0 * y[j].1 * z[k].0,
                        x[i].0 * y[j].0 * z[k].1,
                    );
                    found[count] = (node, x[i].0 * y[j].0 * z[k].0, gradient / self.frame.step);
                    count += 1;
                }
            }
        }
        let found = &found[..count];
        if count == 64 {
            found
                .iter()
                .for_each(|&(node, weight, gradient)| visit(node, weight, gradient));
            return;
        }
        // Close to the cage some nodes are missing: the others share their weight.
        let sum: f64 = found.iter().map(|(_, weight, _)| weight).sum();
        let slope: DVec3 = found.iter().map(|(_, _, gradient)| *gradient).sum();
        for &(node, weight, gradient) in found.iter().filter(|_| sum > 0.0) {
            visit(node, weight / sum, (gradient - slope * (weight / sum)) / sum);
        }
    }

    /// The number of a node of the grid, if it is in the cage.
    fn node(&self, node: I64Vec3) -> Option<usize> {
        let is_in = node.cmpge(I64Vec3::ZERO).all() && node.cmplt(self.frame.counts.as_i64vec3()).all();
        let number = is_in.then(|| self.inside[self.frame.number(node.as_usizevec3())])?;
        (number != OUTSIDE).then_some(number as usize)
    }
}

/// The four cubic B-splines at a position in a cell, and their slopes.
fn cubic(t: f64) -> [(f64, f64); 4] {
    let s = 1.0 - t;
    [
        (s * s * s / 6.0, -0.5 * s * s),
        ((4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0, -2.0 * t + 1.5 * t * t),
        ((4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0, 2.0 * s - 1.5 * s * s),
        (t * t * t / 6.0, 0.5 * t * t),
    ]
}
