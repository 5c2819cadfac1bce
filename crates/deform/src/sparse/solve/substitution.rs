//! A factor laid out for many solves with three right-hand sides, in single or double precision.
//!
//! An iterative method solves once per step and only needs a direction, so single precision is enough. A row of
//! right-hand sides has four numbers, x, y, z and a zero, which is one vector in single precision. The parts of the
//! assembly tree run in parallel (`passes`).

use std::sync::{Mutex, PoisonError};

use pliant_mesh::vectors;
use pulp::{Simd, WithSimd};

use crate::budget::reserved;
use crate::sparse::factor_error::FactorError;
use crate::sparse::numeric::Numbers;
use crate::sparse::solve::blocks::{backward_block, block, copy_node, forward_block, last_block, numbers};
use crate::sparse::solve::passes::forward_and_backward;
use crate::sparse::solve::rhs::{Real, Rhs, minus, plus};
use crate::sparse::symbolic::Symbolic;
use crate::sparse::symbolic::assembly_tree::AssemblyTree;

/// The factor, and the places of its parts.
#[derive(Debug)]
pub(crate) struct Substitution<T> {
    nodes: Vec<Node>,
    values: Vec<T>,
    assembly_tree: AssemblyTree,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    /// Its first column within its part.
    start: u32,
    width: u32,
    /// The start of its rows below among the tree's places, and their number.
    pattern: (u32, u32),
    values: usize,
}

/// Scratch memory for a solve, kept from one to the next.
#[derive(Debug, Default)]
pub(crate) struct Scratch<T> {
    part_rows: Vec<Rows<T>>,
    below: Mutex<Vec<Rows<T>>>,
}

type Rows<T> = Vec<Rhs<T>>;

impl<T: Real> Substitution<T> {
    /// Copies a factor's values.
    ///
    /// # Errors
    /// [`FactorError::Memory`].
    pub fn new(symbolic: &Symbolic, assembly_tree: &AssemblyTree, numbers: &[Numbers]) -> Result<Self, FactorError> {
        let mut nodes = Vec::with_capacity(symbolic.supernode_count());
        let mut copied = reserved(symbolic.stored())?;
        for (part, numbers) in assembly_tree.parts.iter().zip(numbers) {
            let mut panels = numbers.panels.as_slice();
            for s in part.supernodes.clone() {
                let below = symbolic.pattern_range(s);
                let shape = symbolic.shape(s);
                nodes.push(Node {
                    start: (symbolic.columns(s).start - part.columns.start) as u32,
                    width: shape.width as u32,
                    pattern: (below.start as u32, below.len() as u32),
                    values: copied.len(),
                });
                let (panel, tail) = panels.split_at(shape.lines());
                panels = tail;
                copy_node(panel, shape, &mut copied);
            }
        }
        Ok(Self {
            nodes,
            values: copied,
            assembly_tree: assembly_tree.clone(),
        })
    }

    /// The number of stored entries.
    pub fn stored(&self) -> usize {
        self.values.len()
    }

    /// Solves L Lᵀ x = b in place, with one row per column of the factor.
    pub fn solve(&self, x: &mut [Rhs<T>], scratch: &mut Scratch<T>) {
        let arch = vectors();
        let Scratch { part_rows, below } = scratch;
        let spare = &*below;
        let pass = |part: usize, way: Way, x: &mut [Rhs<T>]| {
            let mut below = spare
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .pop()
                .unwrap_or_default();
            arch.dispatch(Pass {
                factor: self,
                nodes: &self.nodes[self.assembly_tree.parts[part].supernodes.clone()],
                way,
                x,
                below: &mut below,
            });
            spare.lock().unwrap_or_else(PoisonError::into_inner).push(below);
        };
        forward_and_backward(
            &self.assembly_tree,
            x,
            part_rows,
            Rhs::default(),
            |row, change| *row = plus(*row, change),
            |part, rows| pass(part, Way::Forward, rows),
            |part, rows| pass(part, Way::Backward, rows),
        );
    }

    /// x ← L⁻¹ x for the supernode's columns, their effect subtracted from the rows below.
    #[inline(always)]
    fn forward(&self, node: &Node, x: &mut [Rhs<T>], below: &mut Vec<Rhs<T>>) {
        let places = self.places_of(node);
        below.clear();
        below.resize(places.len(), Rhs::default());
        let mut values = &self.values[node.values..];
        let own = &mut x[node.start as usize..(node.start + node.width) as usize];
        let mut done = 0;
        while done < own.len() {
            let (_, rest) = own.split_at_mut(done);
            let width = block(rest.len());
            let rows = rest.len() - width + below.len();
            let (numbers, tail) = values.split_at(width * (width + rows));
            match width {
                4 => forward_block::<T, 4>(numbers, rest, below),
                2 => forward_block::<T, 2>(numbers, rest, below),
                _ => forward_block::<T, 1>(numbers, rest, below),
            }
            values = tail;
            done += width;
        }
        for (&place, &sum) in places.iter().zip(below.iter()) {
            let row = &mut x[place as usize];
            *row = minus(*row, sum);
        }
    }

    /// x ← L⁻ᵀ x for the supernode's columns, given the rows below.
    #[inline(always)]
    fn backward(&self, node: &Node, x: &mut [Rhs<T>], below: &mut Vec<Rhs<T>>) {
        let places = self.places_of(node);
        below.clear();
        below.extend(places.iter().map(|&place| x[place as usize]));
        let own = &mut x[node.start as usize..(node.start + node.width) as usize];
        let mut values = &self.values[node.values..node.values + numbers(own.len(), own.len() + places.len())];
        let mut left = own.len();
        let mut behind = 0;
        while left > 0 {
            // The blocks are those of forward substitution, from the last to the first.
            let width = last_block(left);
            let rows = behind + below.len();
            let (tail, numbers) = values.split_at(values.len() - width * (width + rows));
            let rest = &mut own[left - width..];
            match width {
                4 => backward_block::<T, 4>(numbers, rest, below),
                2 => backward_block::<T, 2>(numbers, rest, below),
                _ => backward_block::<T, 1>(numbers, rest, below),
            }
            values = tail;
            left -= width;
            behind += width;
        }
    }

    #[inline(always)]
    fn places_of(&self, node: &Node) -> &[u32] {
        let (start, count) = node.pattern;
        &self.assembly_tree.places[start as usize..(start + count) as usize]
    }
}

/// Forward or backward substitution through some supernodes, compiled for the machine's vectors.
struct Pass<'a, T> {
    factor: &'a Substitution<T>,
    nodes: &'a [Node],
    way: Way,
    x: &'a mut [Rhs<T>],
    below: &'a mut Vec<Rhs<T>>,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Way {
    Forward,
    Backward,
}

impl<T: Real> WithSimd for Pass<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        match self.way {
            Way::Forward => {
                for node in self.nodes {
                    self.factor.forward(node, self.x, self.below);
                }
            }
            Way::Backward => {
                for node in self.nodes.iter().rev() {
                    self.factor.backward(node, self.x, self.below);
                }
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::{Real, Rhs, Scratch};
    use crate::sparse::cholesky::tests::factor_of;
    use pliant_mesh::shapes;

    fn agrees<T: Real>(tolerance: f64) {
        for drawn in [shapes::torus(40, 30), shapes::grid(3, 3), shapes::icosphere(4)] {
            let factor = factor_of(drawn);
            let laid_out = factor.substitution::<T>().unwrap();
            let (symbolic, _) = factor.parts();
            let count = symbolic.column_count();
            let mut expected: Vec<[f64; 3]> = (0..count).map(|i| [1.0, (i % 7) as f64, -0.3]).collect();
            let mut found: Vec<Rhs<T>> = expected
                .iter()
                .map(|row| [T::of(row[0]), T::of(row[1]), T::of(row[2]), T::default()])
                .collect();
            factor.solve(&mut expected);
            let scratch = &mut Scratch::default();
            let input = found.clone();
            laid_out.solve(&mut found, scratch);
            let largest = expected.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
            for (expected, found) in expected.iter().zip(&found) {
                for k in 0..3 {
                    let error = (expected[k] - found[k].wide()).abs() / largest;
                    assert!(error < tolerance, "{error:e}");
                }
            }
            // Scratch memory that was used before changes nothing.
            let mut again = input;
            laid_out.solve(&mut again, scratch);
            assert!(
                again
                    .iter()
                    .flatten()
                    .zip(found.iter().flatten())
                    .all(|(a, b)| a.wide() == b.wide())
            );
        }
    }

    #[test]
    fn it_solves_what_the_factor_solves_in_either_precision() {
        agrees::<f64>(1e-9);
        agrees::<f32>(1e-2);
    }
}
