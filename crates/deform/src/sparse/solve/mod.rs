//! Solving with a factor, several right-hand sides at once.
//!
//! The limit is memory bandwidth: each solve reads the factor twice. So it is read in the order in which it is stored,
//! and each line is used for all right-hand sides at once. The parts of the assembly tree are solved in parallel
//! (`passes`). faer's own parallel solve was 3 to 40 times slower than its sequential one on such factors.

mod blocks;
mod kernels;
mod passes;
pub(crate) mod rhs;
pub(crate) mod substitution;

use std::sync::{Mutex, PoisonError};

use pliant_mesh::vectors;

use crate::sparse::line::{LANES, Line, Shape};
use crate::sparse::numeric::Numbers;
use crate::sparse::solve::kernels::{Backward, Forward, Strip};
use crate::sparse::solve::passes::forward_and_backward;
use crate::sparse::symbolic::Symbolic;
use crate::sparse::symbolic::assembly_tree::AssemblyTree;

/// Scratch memory for one supernode's rows.
#[derive(Default)]
struct Scratch<const K: usize> {
    x: Vec<Strip<K>>,
    rows: Vec<[f64; K]>,
    sums: Vec<Strip<K>>,
}

impl<const K: usize> Scratch<K> {
    /// Lays the supernode's own rows out in strips; those below are zero.
    fn begin(&mut self, shape: Shape, own: &[[f64; K]]) {
        self.x.clear();
        self.x.resize(shape.strips(), [Line::ZERO; K]);
        for (i, row) in own.iter().enumerate() {
            for k in 0..K {
                self.x[i / LANES][k].0[i % LANES] = row[k];
            }
        }
    }
}

/// The rows that each part of the assembly tree works on while K right-hand sides are solved for.
pub(crate) type PartRows<const K: usize> = Vec<Vec<[f64; K]>>;

/// Solves L Lᵀ x = b in place; `x` has one row per column of the factor. In parts that are not wanted it is left half
/// solved; parts above a wanted one must be wanted too. `part_rows` is scratch memory.
pub(crate) fn solve_in_place<const K: usize>(
    symbolic: &Symbolic,
    assembly_tree: &AssemblyTree,
    numbers: &[Numbers],
    x: &mut [[f64; K]],
    part_rows: &mut PartRows<K>,
    is_wanted: impl Fn(usize) -> bool + Sync,
) {
    let pool = Mutex::new(Vec::<Scratch<K>>::new());
    let with_scratch = |run: &mut dyn FnMut(&mut Scratch<K>)| {
        let pooled = pool.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut scratch = pooled.unwrap_or_default();
        run(&mut scratch);
        pool.lock().unwrap_or_else(PoisonError::into_inner).push(scratch);
    };
    let supernode = |part: usize, s: usize| {
        let first = symbolic.columns(s).start - assembly_tree.parts[part].columns.start;
        (
            symbolic.shape(s),
            first,
            &assembly_tree.places[symbolic.pattern_range(s)],
        )
    };
    let forward_part = |part: usize, rows: &mut [[f64; K]]| {
        with_scratch(&mut |scratch| {
            let mut panels = numbers[part].panels.as_slice();
            for s in assembly_tree.parts[part].supernodes.clone() {
                let (shape, first, places) = supernode(part, s);
                let (panel, tail) = panels.split_at(shape.lines());
                panels = tail;
                forward(shape, panel, first, places, rows, scratch);
            }
        });
    };
    let backward_part = |part: usize, rows: &mut [[f64; K]]| {
        if !is_wanted(part) {
            return;
        }
        with_scratch(&mut |scratch| {
            let mut panels = numbers[part].panels.as_slice();
            for s in assembly_tree.parts[part].supernodes.clone().rev() {
                let (shape, first, places) = supernode(part, s);
                let (tail, panel) = panels.split_at(panels.len() - shape.lines());
                panels = tail;
                backward(shape, panel, first, places, rows, scratch);
            }
        });
    };
    let add = |row: &mut [f64; K], change: [f64; K]| {
        for k in 0..K {
            row[k] += change[k];
        }
    };
    forward_and_backward(assembly_tree, x, part_rows, [0.0; K], add, forward_part, backward_part);
}

/// x ← L⁻¹ x for the supernode's columns, their effect subtracted from the rows below.
fn forward<const K: usize>(
    shape: Shape,
    panel: &[Line],
    first: usize,
    places: &[u32],
    x: &mut [[f64; K]],
    scratch: &mut Scratch<K>,
) {
    let own = first..first + shape.width;
    // Most rows of a handle's right-hand side are zero, and zero rows do not change the rows below.
    if x[own.clone()].iter().all(|row| *row == [0.0; K]) {
        return;
    }
    scratch.begin(shape, &x[own.clone()]);
    vectors().dispatch(Forward {
        shape,
        panel,
        x: &mut scratch.x,
        rows: &mut scratch.rows,
    });
    x[own].copy_from_slice(&scratch.rows);
    for (places, strip) in places.chunks(LANES).zip(&scratch.x[shape.own()..]) {
        for (lane, &place) in places.iter().enumerate() {
            let row = &mut x[place as usize];
            for k in 0..K {
                row[k] -= strip[k].0[lane];
            }
        }
    }
}

/// x ← L⁻ᵀ x for the supernode's columns, given the rows below.
fn backward<const K: usize>(
    shape: Shape,
    panel: &[Line],
    first: usize,
    places: &[u32],
    x: &mut [[f64; K]],
    scratch: &mut Scratch<K>,
) {
    let own = first..first + shape.width;
    scratch.begin(shape, &x[own.clone()]);
    for (places, strip) in places.chunks(LANES).zip(&mut scratch.x[shape.own()..]) {
        for (lane, &place) in places.iter().enumerate() {
            let row = &x[place as usize];
            for k in 0..K {
                strip[k].0[lane] = row[k];
            }
        }
    }
    vectors().dispatch(Backward {
        shape,
        panel,
        x: &mut scratch.x,
        sums: &mut scratch.sums,
    });
    for (i, row) in x[own].iter_mut().enumerate() {
        for k in 0..K {
            row[k] = scratch.x[i / LANES][k].0[i % LANES];
        }
    }
}
