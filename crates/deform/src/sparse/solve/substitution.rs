//! A factor laid out for solving again and again with three right-hand sides, in single or double precision.
//!
//! An iterative method solves once a step and only needs a direction, so half the bytes are enough. Each supernode's
//! columns stand in blocks of up to four, row by row: a row's four numbers meet four finished values in registers, and
//! what is below is read and written once for four columns. The right-hand sides are rows of four, x, y, z and nothing,
//! which is one vector in single precision. The parts that `assembly_tree` cuts run beside each other, as in `triangular`.

use std::ops::{Add, Mul, Sub};
use std::sync::{Mutex, PoisonError};

use pulp::{Arch, Simd, WithSimd};

use crate::budget::reserved;
use crate::numerical::prefetch::Prefetch;
use crate::sparse::factor_error::FactorError;
use crate::sparse::numeric::Numbers;
use crate::sparse::numeric::line::{Line, Shape};
use crate::sparse::solve::passes::forward_and_backward;
use crate::sparse::symbolic::Symbolic;
use crate::sparse::symbolic::assembly_tree::AssemblyTree;

/// A precision to solve in.
pub(crate) trait Real:
    Copy + Default + Send + Sync + std::fmt::Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + 'static
{
    /// Rounded to it.
    fn of(value: f64) -> Self;
    /// The same number.
    fn wide(self) -> f64;
}

impl Real for f32 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value as Self
    }
    #[inline(always)]
    fn wide(self) -> f64 {
        f64::from(self)
    }
}

impl Real for f64 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn wide(self) -> f64 {
        self
    }
}

/// Numbers between those that are read on the way down and those that are asked for: some blocks of the usual size.
const AHEAD: usize = 1024;

/// One row of three right-hand sides: x, y, z and a zero.
pub(crate) type Rhs<T> = [T; 4];

/// The factor, and where its parts lie.
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
    /// Where its rows below begin among the tree's places, and how many they are.
    pattern: (u32, u32),
    values: usize,
}

/// Room for a solve, kept from one to the next.
#[derive(Debug, Default)]
pub(crate) struct Room<T> {
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

    /// How many numbers it stores.
    pub fn stored(&self) -> usize {
        self.values.len()
    }

    /// Solves L Lᵀ x = b in place, one row a column of the factor.
    pub fn solve(&self, x: &mut [Rhs<T>], room: &mut Room<T>) {
        let arch = Arch::new();
        let Room { part_rows, below } = room;
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
            // The blocks of the way forward, from the last to the first.
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

/// One way through some supernodes; what is in here is compiled for the machine's vectors.
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

/// The width of the next block of so many columns.
#[inline(always)]
fn block(columns: usize) -> usize {
    match columns {
        0 | 1 => 1,
        2 | 3 => 2,
        _ => 4,
    }
}

/// The width of the last block of so many columns, taken from the front.
#[inline(always)]
fn last_block(columns: usize) -> usize {
    match columns % 4 {
        0 => 4,
        2 => 2,
        _ => 1,
    }
}

/// How many numbers a supernode's blocks hold.
#[inline(always)]
fn numbers(width: usize, height: usize) -> usize {
    let (mut count, mut done) = (0, 0);
    while done < width {
        let block = block(width - done);
        count += block * (height - done);
        done += block;
    }
    count
}

/// Appends a supernode's columns as blocks, diagonals as their inverses.
fn copy_node<T: Real>(panel: &[Line], shape: Shape, copied: &mut Vec<T>) {
    let mut done = 0;
    while done < shape.width {
        let block = block(shape.width - done);
        for row in done..shape.width + shape.below {
            let (start, lane) = shape.row(row);
            for column in done..done + block {
                copied.push(if row < column {
                    T::default()
                } else {
                    T::of(panel[start + column].0[lane])
                });
            }
        }
        done += block;
    }
}

/// `rest` starts with the block's own rows.
#[inline(always)]
fn forward_block<T: Real, const B: usize>(numbers: &[T], rest: &mut [Rhs<T>], below: &mut [Rhs<T>]) {
    let (triangle, numbers) = numbers.split_at(B * B);
    let (own, rest) = rest.split_at_mut(B);
    let mut values = [Rhs::default(); B];
    values.copy_from_slice(own);
    for c in 0..B {
        values[c] = times(values[c], triangle[c * B + c]);
        for r in c + 1..B {
            values[r] = minus(values[r], times(values[c], triangle[r * B + c]));
        }
    }
    own.copy_from_slice(&values);
    let (inside, outside) = numbers.split_at(rest.len() * B);
    for (row, numbers) in rest.iter_mut().zip(inside.chunks_exact(B)) {
        for c in 0..B {
            *row = minus(*row, times(values[c], numbers[c]));
        }
    }
    for (row, numbers) in below.iter_mut().zip(outside.chunks_exact(B)) {
        for c in 0..B {
            *row = plus(*row, times(values[c], numbers[c]));
        }
    }
}

/// `rest` starts with the block's own rows.
#[inline(always)]
fn backward_block<T: Real, const B: usize>(numbers: &[T], rest: &mut [Rhs<T>], below: &[Rhs<T>]) {
    let (triangle, numbers) = numbers.split_at(B * B);
    let (own, rest) = rest.split_at_mut(B);
    let mut sums = [Rhs::default(); B];
    let (inside, outside) = numbers.split_at(rest.len() * B);
    for (row, numbers) in rest.iter().zip(inside.chunks_exact(B)) {
        for c in 0..B {
            sums[c] = plus(sums[c], times(*row, numbers[c]));
        }
    }
    let prefetch = Prefetch::new();
    for (row, numbers) in below.iter().zip(outside.chunks_exact(B)) {
        prefetch.below(&numbers[0], AHEAD);
        for c in 0..B {
            sums[c] = plus(sums[c], times(*row, numbers[c]));
        }
    }
    for c in (0..B).rev() {
        let mut value = minus(own[c], sums[c]);
        for r in c + 1..B {
            value = minus(value, times(own[r], triangle[r * B + c]));
        }
        own[c] = times(value, triangle[c * B + c]);
    }
}

#[inline(always)]
fn plus<T: Real>(a: Rhs<T>, b: Rhs<T>) -> Rhs<T> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]]
}

#[inline(always)]
fn minus<T: Real>(a: Rhs<T>, b: Rhs<T>) -> Rhs<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
}

#[inline(always)]
fn times<T: Real>(a: Rhs<T>, factor: T) -> Rhs<T> {
    [a[0] * factor, a[1] * factor, a[2] * factor, a[3] * factor]
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::{Real, Rhs, Room};
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
            let room = &mut Room::default();
            let input = found.clone();
            laid_out.solve(&mut found, room);
            let largest = expected.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
            for (expected, found) in expected.iter().zip(&found) {
                for k in 0..3 {
                    let error = (expected[k] - found[k].wide()).abs() / largest;
                    assert!(error < tolerance, "{error:e}");
                }
            }
            // Room that was used before changes nothing.
            let mut again = input;
            laid_out.solve(&mut again, room);
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
