//! Symbolic factorisation: the supernodes of a factor and the rows of each.
//!
//! The order of elimination comes with its supernodes (`dissection`, `leaf`), so none need to be detected. A
//! supernode's rows are exactly those of its columns in the matrix and those of its children's contributions.

pub(crate) mod assembly_tree;

use std::ops::Range;

use crate::budget::{Budget, Limit, bytes_of};
use crate::sparse::factor_error::FactorError;
use crate::sparse::line::{LANES, Line, Shape, strips, triangle};
use crate::sparse::matrix::ScaledMatrix;

/// No parent: a root.
pub(crate) const ROOT: u32 = u32::MAX;

/// The needs of a factorisation, supernode by supernode.
#[derive(Default)]
struct Needed {
    rows: usize,
    panel_lines: usize,
    /// Lines of the contribution matrices that wait for their parents, now and at most.
    waiting: usize,
    most_waiting: usize,
    operations: f64,
}

impl Needed {
    /// Adds the next supernode, given the lines of its children's contributions.
    fn meet(&mut self, width: usize, below: usize, passed_on: usize) {
        let own = contribution_lines(below);
        self.rows += below;
        self.panel_lines = self.panel_lines.saturating_add(Shape { width, below }.lines());
        self.most_waiting = self.most_waiting.max(self.waiting + own);
        self.waiting = self.waiting + own - passed_on;
        self.operations += operations(width, below);
    }

    /// The memory in bytes.
    fn bytes(&self) -> u64 {
        // The rows are stored twice: in the factor's columns and in their part's.
        let lines = self.panel_lines.saturating_add(self.most_waiting);
        bytes_of(lines, size_of::<Line>()).saturating_add(bytes_of(self.rows, 8))
    }
}

/// Multiplications and additions of a dense factorisation of `width` columns with `below` rows below: the sum of the
/// squared column counts.
fn operations(width: usize, below: usize) -> f64 {
    let (width, below) = (width as f64, below as f64);
    width * (width * width / 3.0 + width * below + below * below)
}

/// Lines of the contribution matrix of a supernode with this many rows below.
pub(crate) fn contribution_lines(below: usize) -> usize {
    triangle(strips(below))
}

/// The supernodes of a factor.
#[derive(Debug)]
pub(crate) struct Symbolic {
    /// The end of each supernode's columns; begins with 0.
    starts: Vec<u32>,
    /// The start of each supernode's pattern among `rows`, and the end.
    row_starts: Vec<usize>,
    /// The rows below each supernode's own, ascending.
    pub rows: Vec<u32>,
    /// The supernode with the first row of each supernode's pattern, [`ROOT`] if there is none.
    pub parent: Vec<u32>,
    /// The number of each supernode's children.
    pub child_counts: Vec<u32>,
}

impl Symbolic {
    /// The factor of `matrix`, whose columns are grouped in supernodes that end at `ends`.
    ///
    /// # Errors
    /// Returned as soon as the known part exceeds the budget: its numbers, its rows, the contributions that wait at
    /// once, or the operations of its factorisation.
    pub fn of(matrix: &ScaledMatrix, ends: &[u32], budget: Budget) -> Result<Self, FactorError> {
        let column_count = matrix.scale.len();
        let mut symbolic = Self {
            starts: std::iter::once(0).chain(ends.iter().copied()).collect(),
            row_starts: vec![0],
            rows: Vec::new(),
            parent: Vec::with_capacity(ends.len()),
            child_counts: vec![0; ends.len()],
        };
        let mut supernode_of = vec![0_u32; column_count];
        for s in 0..ends.len() {
            supernode_of[symbolic.columns(s)].fill(s as u32);
        }
        // The finished children of a supernode, as a list: the last one, and the one before each.
        let (mut last_child, mut sibling) = (vec![ROOT; ends.len()], vec![ROOT; ends.len()]);
        let mut seen = vec![ROOT; column_count];
        let mut rows = Vec::new();
        let mut needed = Needed::default();
        let most_operations = budget.operations_for(column_count);
        for s in 0..ends.len() {
            let own = symbolic.columns(s);
            let end = own.end as u32;
            rows.clear();
            let mut meet = |row: u32| {
                if row >= end && std::mem::replace(&mut seen[row as usize], s as u32) != s as u32 {
                    rows.push(row);
                }
            };
            let mut child = last_child[s];
            let mut passed_on = 0;
            while child != ROOT {
                passed_on += contribution_lines(symbolic.pattern(child as usize).len());
                symbolic.pattern(child as usize).iter().copied().for_each(&mut meet);
                child = sibling[child as usize];
            }
            let entries = matrix.lower_offsets[own.start] as usize..matrix.lower_offsets[own.end] as usize;
            matrix.lower_rows[entries].iter().copied().for_each(&mut meet);
            rows.sort_unstable();
            let parent = rows.first().map_or(ROOT, |&row| supernode_of[row as usize]);
            if parent != ROOT {
                symbolic.child_counts[parent as usize] += 1;
                sibling[s] = std::mem::replace(&mut last_child[parent as usize], s as u32);
            }
            needed.meet(own.len(), rows.len(), passed_on);
            budget.without(needed.bytes())?;
            if needed.operations > most_operations {
                return Err(Limit::Operations(most_operations as u64).into());
            }
            symbolic.parent.push(parent);
            symbolic.rows.try_reserve(rows.len())?;
            symbolic.rows.extend_from_slice(&rows);
            symbolic.row_starts.push(symbolic.rows.len());
        }
        Ok(symbolic)
    }

    /// The number of supernodes.
    pub fn supernode_count(&self) -> usize {
        self.parent.len()
    }

    /// The number of columns.
    pub fn column_count(&self) -> usize {
        self.starts[self.parent.len()] as usize
    }

    /// The number of stored entries, padding of strips included.
    pub fn stored(&self) -> usize {
        (0..self.supernode_count()).map(|s| LANES * self.shape(s).lines()).sum()
    }

    /// A supernode's columns and the rows below them.
    pub fn shape(&self, s: usize) -> Shape {
        Shape {
            width: self.columns(s).len(),
            below: self.pattern_range(s).len(),
        }
    }

    /// A supernode's columns.
    pub fn columns(&self, s: usize) -> Range<usize> {
        self.starts[s] as usize..self.starts[s + 1] as usize
    }

    /// The rows below a supernode's own columns, ascending.
    pub fn pattern(&self, s: usize) -> &[u32] {
        &self.rows[self.pattern_range(s)]
    }

    /// The place of a supernode's pattern among all of them.
    pub fn pattern_range(&self, s: usize) -> Range<usize> {
        self.row_starts[s]..self.row_starts[s + 1]
    }

    /// Multiplications and additions of a dense factorisation of a supernode.
    pub fn work(&self, s: usize) -> f64 {
        operations(self.columns(s).len(), self.pattern(s).len())
    }
}
