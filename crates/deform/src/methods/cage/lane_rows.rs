//! Rows of coordinates, eight rows side by side, and their products with displacements.

use std::collections::TryReserveError;

use glam::DVec3;
use pliant_mesh::vectors;
use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use crate::budget::{bytes_of, filled};
use crate::handles::bases::Stored;
use crate::numerical::lanes::LANES;

/// A dense matrix with a row for each point and a column for each coordinate. A product reads it once from one end to
/// the other.
#[derive(Debug)]
pub(super) struct LaneRows<T> {
    row_count: usize,
    column_count: usize,
    /// All columns of eight rows, then those of the next eight.
    blocks: Vec<[T; LANES]>,
}

/// The number of blocks of eight rows that one task takes.
pub(super) const BLOCKS: usize = 32;

/// The bytes of a matrix of this size.
pub(super) fn lane_rows_bytes<T>(row_count: usize, column_count: usize) -> u64 {
    bytes_of(row_count.div_ceil(LANES), column_count * size_of::<[T; LANES]>())
}

impl<T: Stored> LaneRows<T> {
    /// Makes a matrix of zeros.
    ///
    /// # Errors
    /// The machine has no memory for it.
    pub fn zeros(row_count: usize, column_count: usize) -> Result<Self, TryReserveError> {
        Ok(Self {
            row_count,
            column_count,
            blocks: filled([T::default(); LANES], row_count.div_ceil(LANES) * column_count)?,
        })
    }

    /// Makes a matrix from its entries.
    ///
    /// # Errors
    /// The machine has no memory for it.
    pub fn of(
        row_count: usize,
        column_count: usize,
        entry: impl Fn(usize, usize) -> f64,
    ) -> Result<Self, TryReserveError> {
        let mut rows = Self::zeros(row_count, column_count)?;
        for row in 0..row_count {
            for column in 0..column_count {
                rows.blocks[row / LANES * column_count + column][row % LANES] = T::of(entry(row, column));
            }
        }
        Ok(rows)
    }

    /// The blocks of eight rows each, for writing: for each column eight numbers.
    pub fn blocks_mut(&mut self) -> rayon::slice::ChunksExactMut<'_, [T; LANES]> {
        self.blocks.par_chunks_exact_mut(self.column_count)
    }

    /// The blocks of one task after the other.
    pub fn tasks_mut(&mut self) -> rayon::slice::ChunksMut<'_, [T; LANES]> {
        self.blocks.par_chunks_mut(self.column_count * BLOCKS)
    }

    /// Each row's Σ entry × term over the columns.
    pub fn product(&self, terms: &[DVec3]) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; self.row_count];
        let blocks = sums.par_chunks_mut(LANES).enumerate().with_min_len(BLOCKS);
        blocks.for_each(|(block, out)| out.copy_from_slice(&self.block_product(block, terms)[..out.len()]));
        sums
    }

    /// The sums of the eight rows of a block.
    pub fn block_product(&self, block: usize, terms: &[DVec3]) -> [DVec3; LANES] {
        let rows = &self.blocks[block * self.column_count..][..self.column_count];
        vectors().dispatch(Product { rows, terms })
    }
}

/// Changes a table's entries of these ascending vertices, each of which is a row: `change` gets each block's number and
/// the entries of its rows.
pub(super) fn by_blocks<T: Send>(
    vertices: &[u32],
    mut table: &mut [T],
    change: impl Fn(usize, &mut dyn Iterator<Item = &mut T>) + Sync,
) {
    let mut start = 0;
    let mut tasks = Vec::new();
    for own in vertices.chunks(LANES * BLOCKS) {
        let end = own.last().map_or(start, |last| *last as usize + 1);
        let (piece, rest) = table.split_at_mut(end - start);
        tasks.push((own, start, piece));
        (start, table) = (end, rest);
    }
    tasks
        .into_par_iter()
        .enumerate()
        .for_each(|(task, (own, start, mut piece))| {
            let mut start = start;
            for (block, own) in own.chunks(LANES).enumerate() {
                let end = own.last().map_or(start, |last| *last as usize + 1);
                let (entries, rest) = piece.split_at_mut(end - start);
                let mut own = own.iter().map(|vertex| *vertex as usize - start).peekable();
                let rows = entries.iter_mut().enumerate();
                let mut rows = rows.filter_map(|(place, entry)| own.next_if_eq(&place).map(|_| entry));
                change(task * BLOCKS + block, &mut rows);
                (start, piece) = (end, rest);
            }
        });
}

/// Eight rows times the terms.
struct Product<'a, T> {
    rows: &'a [[T; LANES]],
    terms: &'a [DVec3],
}

impl<T: Stored> WithSimd for Product<'_, T> {
    type Output = [DVec3; LANES];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [DVec3; LANES] {
        let mut sum = [[0.0; LANES]; 3];
        for (row, term) in self.rows.iter().zip(self.terms) {
            for lane in 0..LANES {
                // All sums are in f64.
                let entry: f64 = row[lane].into();
                sum[0][lane] += entry * term.x;
                sum[1][lane] += entry * term.y;
                sum[2][lane] += entry * term.z;
            }
        }
        let [x, y, z] = sum;
        std::array::from_fn(|lane| DVec3::new(x[lane], y[lane], z[lane]))
    }
}
