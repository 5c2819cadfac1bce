//! Solving with a supernodal factor, several right-hand sides at once.
//!
//! The limit is memory: each solve reads the factor twice. So its columns are read in the order in which they lie, and
//! used for all right-hand sides while they are in the cache: a supernode's rows are gathered, one field after the other,
//! for `kernels`. The subtrees that `forest` cuts are solved beside each other, each on a copy of its rows
//! followed by those that it changes outside; above them it goes on one by one. faer's own parallel solve was 3 to 40
//! times slower than its sequential one on such factors.

use pulp::Arch;
use rayon::prelude::*;

use crate::sparse::forest::{Forest, Part};
use crate::sparse::kernels;
use crate::sparse::symbolic::Symbolic;

/// Solves L Lᵀ x = b in place.
///
/// `values` are the factor's, `x` has one row a column of the factor.
pub(crate) fn solve_in_place<const K: usize>(symbolic: &Symbolic, forest: &Forest, values: &[f64], x: &mut [[f64; K]]) {
    let factor = Stored {
        symbolic,
        forest,
        values,
    };
    let tasks: Vec<_> = forest
        .parts
        .iter()
        .filter_map(|part| match part {
            Part::Task(range) => Some(range.clone()),
            Part::Top(_) => None,
        })
        .collect();
    let own = |task: &std::ops::Range<usize>| symbolic.columns(task.start).start..symbolic.columns(task.end - 1).end;
    let outside = |task: &std::ops::Range<usize>| symbolic.pattern(task.end - 1);
    let mut parts: Vec<Vec<[f64; K]>> = tasks
        .par_iter()
        .with_max_len(1)
        .map(|task| {
            let own = own(task);
            let mut part = Vec::with_capacity(own.len() + outside(task).len());
            part.extend_from_slice(&x[own.clone()]);
            part.resize(own.len() + outside(task).len(), [0.0; K]);
            let mut below = room::<K>(symbolic, task.clone());
            for s in task.clone() {
                forward(&factor.supernode(s, own.start), &mut part, &mut below);
            }
            part
        })
        .collect();
    // What the tasks change outside is added up in their order, whoever was done first.
    for (task, part) in tasks.iter().zip(&parts) {
        for (&row, change) in outside(task).iter().zip(&part[own(task).len()..]) {
            for k in 0..K {
                x[row as usize][k] += change[k];
            }
        }
    }
    let top = forest.parts.iter().filter_map(|part| match part {
        Part::Top(s) => Some(*s),
        Part::Task(_) => None,
    });
    let mut below = room::<K>(symbolic, 0..symbolic.block_count());
    for s in top.clone() {
        forward(&factor.supernode(s, 0), x, &mut below);
    }
    for s in top.rev() {
        backward(&factor.supernode(s, 0), x, &mut below);
    }
    tasks
        .par_iter()
        .zip(&mut parts)
        .with_max_len(1)
        .for_each(|(task, part)| {
            let own = own(task);
            for (&row, value) in outside(task).iter().zip(&mut part[own.len()..]) {
                *value = x[row as usize];
            }
            let mut below = room::<K>(symbolic, task.clone());
            for s in task.clone().rev() {
                backward(&factor.supernode(s, own.start), part, &mut below);
            }
        });
    for (task, part) in tasks.iter().zip(&parts) {
        let own = own(task);
        x[own.clone()].copy_from_slice(&part[..own.len()]);
    }
}

/// Room for the K fields on the rows of the highest of these supernodes.
fn room<const K: usize>(symbolic: &Symbolic, supernodes: std::ops::Range<usize>) -> Vec<f64> {
    let widest = supernodes
        .map(|s| symbolic.columns(s).len() + symbolic.pattern(s).len())
        .max();
    vec![0.0; K * widest.unwrap_or(0)]
}

/// The factor as it is stored.
struct Stored<'a> {
    symbolic: &'a Symbolic,
    forest: &'a Forest,
    values: &'a [f64],
}

/// Columns with one pattern: a dense triangle on `rows`' own columns and a dense block below it.
struct Supernode<'a> {
    start: usize,
    width: usize,
    /// The rows below the triangle.
    pattern: &'a [u32],
    /// Column-major, `width + pattern.len()` high.
    values: &'a [f64],
}

impl<'a> Stored<'a> {
    /// A supernode whose part's first column is `first`.
    fn supernode(&self, s: usize, first: usize) -> Supernode<'a> {
        let own = self.symbolic.columns(s);
        Supernode {
            start: own.start - first,
            width: own.len(),
            pattern: &self.forest.places[self.symbolic.pattern_range(s)],
            values: &self.values[self.symbolic.values(s..s + 1)],
        }
    }
}

/// x ← L⁻¹ x for the supernode's columns, their effect subtracted from the rows below.
fn forward<const K: usize>(node: &Supernode, x: &mut [[f64; K]], room: &mut [f64]) {
    let own = node.start..node.start + node.width;
    // Most of a right-hand side that begins at a handle's rim is zero, and so is what it leaves.
    if x[own.clone()].iter().all(|row| *row == [0.0; K]) {
        return;
    }
    let height = node.width + node.pattern.len();
    let fields = &mut room[..K * height];
    for (i, row) in x[own.clone()].iter().enumerate() {
        for k in 0..K {
            fields[k * height + i] = row[k];
        }
    }
    for field in fields.chunks_exact_mut(height) {
        field[node.width..].fill(0.0);
    }
    Arch::new().dispatch(|| kernels::forward(node.values, node.width, height, fields));
    for (i, row) in x[own].iter_mut().enumerate() {
        for k in 0..K {
            row[k] = fields[k * height + i];
        }
    }
    for (i, &row) in (node.width..).zip(node.pattern) {
        let target = &mut x[row as usize];
        for k in 0..K {
            target[k] += fields[k * height + i];
        }
    }
}

/// x ← L⁻ᵀ x for the supernode's columns, given the rows below.
fn backward<const K: usize>(node: &Supernode, x: &mut [[f64; K]], room: &mut [f64]) {
    let height = node.width + node.pattern.len();
    let own = node.start..node.start + node.width;
    let fields = &mut room[..K * height];
    let rows = x[own.clone()]
        .iter()
        .chain(node.pattern.iter().map(|&row| &x[row as usize]));
    for (i, row) in rows.enumerate() {
        for k in 0..K {
            fields[k * height + i] = row[k];
        }
    }
    Arch::new().dispatch(|| kernels::backward(node.values, node.width, height, fields));
    for (i, row) in x[own].iter_mut().enumerate() {
        for k in 0..K {
            row[k] = fields[k * height + i];
        }
    }
}
