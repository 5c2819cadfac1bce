//! Solving with a supernodal factor, several right-hand sides at once.
//!
//! The limit is memory: each solve reads the factor twice. So the right-hand sides stand side by side (`[f64; K]` a
//! row), each entry of the factor is used for all of them while it is in a register, and its columns are read in the
//! order in which they lie. The subtrees that `forest` cuts are solved beside each other, each on a copy of its rows
//! followed by those that it changes outside; above them it goes on one by one. faer's own parallel solve was 3 to 40
//! times slower than its sequential one on such factors. Loops compiled for wider vectors gained nothing.

use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use rayon::prelude::*;

use crate::sparse::forest::{Forest, Part, columns, pattern, pattern_range};

/// Solves L Lᵀ x = b in place.
///
/// `values` are the factor's, `x` has one row a column of the factor.
pub(crate) fn solve_in_place<const K: usize>(
    symbolic: &SymbolicSupernodalCholesky<u32>,
    forest: &Forest,
    values: &[f64],
    x: &mut [[f64; K]],
) {
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
    let own = |task: &std::ops::Range<usize>| columns(symbolic, task.start).start..columns(symbolic, task.end - 1).end;
    let outside = |task: &std::ops::Range<usize>| pattern(symbolic, task.end - 1);
    let mut parts: Vec<Vec<[f64; K]>> = tasks
        .par_iter()
        .with_max_len(1)
        .map(|task| {
            let own = own(task);
            let mut part = Vec::with_capacity(own.len() + outside(task).len());
            part.extend_from_slice(&x[own.clone()]);
            part.resize(own.len() + outside(task).len(), [0.0; K]);
            let mut below = room(symbolic, task.clone());
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
    let mut below = room(symbolic, 0..symbolic.n_supernodes());
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
            let mut below = room(symbolic, task.clone());
            for s in task.clone().rev() {
                backward(&factor.supernode(s, own.start), part, &mut below);
            }
        });
    for (task, part) in tasks.iter().zip(&parts) {
        let own = own(task);
        x[own.clone()].copy_from_slice(&part[..own.len()]);
    }
}

/// Room for the longest pattern among these supernodes: most tasks are small, and so is theirs.
fn room<const K: usize>(
    symbolic: &SymbolicSupernodalCholesky<u32>,
    supernodes: std::ops::Range<usize>,
) -> Vec<[f64; K]> {
    let widest = symbolic.nnz_per_super()[supernodes].iter().copied().max();
    vec![[0.0; K]; widest.unwrap_or(0) as usize]
}

/// The factor as it is stored.
struct Stored<'a> {
    symbolic: &'a SymbolicSupernodalCholesky<u32>,
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
        let own = columns(self.symbolic, s);
        let starts = self.symbolic.col_ptr_for_val();
        Supernode {
            start: own.start - first,
            width: own.len(),
            pattern: &self.forest.places[pattern_range(self.symbolic, s)],
            values: &self.values[starts[s] as usize..starts[s + 1] as usize],
        }
    }
}

impl<'a> Supernode<'a> {
    fn column(&self, j: usize) -> &'a [f64] {
        let height = self.width + self.pattern.len();
        &self.values[j * height..(j + 1) * height]
    }
}

/// x ← L⁻¹ x for the supernode's columns, their effect subtracted from the rows below.
fn forward<const K: usize>(node: &Supernode, x: &mut [[f64; K]], below: &mut [[f64; K]]) {
    let below = &mut below[..node.pattern.len()];
    below.fill([0.0; K]);
    let own = &mut x[node.start..node.start + node.width];
    for j in 0..node.width {
        let column = &node.column(j)[j..];
        let value = own[j].map(|value| value / column[0]);
        own[j] = value;
        let (inside, outside) = column[1..].split_at(node.width - j - 1);
        for (row, &entry) in own[j + 1..].iter_mut().zip(inside) {
            for k in 0..K {
                row[k] -= entry * value[k];
            }
        }
        for (row, &entry) in below.iter_mut().zip(outside) {
            for k in 0..K {
                row[k] += entry * value[k];
            }
        }
    }
    for (&row, sum) in node.pattern.iter().zip(below.iter()) {
        let target = &mut x[row as usize];
        for k in 0..K {
            target[k] -= sum[k];
        }
    }
}

/// x ← L⁻ᵀ x for the supernode's columns, given the rows below.
fn backward<const K: usize>(node: &Supernode, x: &mut [[f64; K]], below: &mut [[f64; K]]) {
    let below = &mut below[..node.pattern.len()];
    for (&row, value) in node.pattern.iter().zip(below.iter_mut()) {
        *value = x[row as usize];
    }
    let own = &mut x[node.start..node.start + node.width];
    for j in (0..node.width).rev() {
        let column = &node.column(j)[j..];
        let (inside, outside) = column[1..].split_at(node.width - j - 1);
        let mut value = own[j];
        let mut sums = [[0.0; K]; 2];
        let pairs = outside.chunks_exact(2).zip(below.chunks_exact(2));
        for (entries, rows) in pairs {
            for k in 0..K {
                sums[0][k] += entries[0] * rows[0][k];
                sums[1][k] += entries[1] * rows[1][k];
            }
        }
        if outside.len() % 2 == 1
            && let (Some(entry), Some(row)) = (outside.last(), below.last())
        {
            for k in 0..K {
                sums[0][k] += entry * row[k];
            }
        }
        for (row, &entry) in own[j + 1..].iter().zip(inside) {
            for k in 0..K {
                sums[1][k] += entry * row[k];
            }
        }
        for k in 0..K {
            value[k] = (value[k] - (sums[0][k] + sums[1][k])) / column[0];
        }
        own[j] = value;
    }
}
