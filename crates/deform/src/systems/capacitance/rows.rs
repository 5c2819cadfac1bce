//! The rows of D^½ C T: one for each constrained vertex beside a solved one, and one for each spring.

use rayon::prelude::*;

use crate::numerical::rows::CHUNK;
use crate::sparse::matrix::CONSTRAINED;
use crate::systems::operator::BilaplacianOperator;

/// Compressed rows over the columns of the factor.
#[derive(Debug)]
pub(super) struct CapacitanceRows {
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl CapacitanceRows {
    /// The rows for columns of this `scale`; `resistance` gives D of a constrained vertex. A vertex of zero resistance
    /// (a hinge) has no row.
    pub fn of(
        operator: &BilaplacianOperator,
        column_of: &[u32],
        scale: &[f64],
        resistance: impl Fn(usize) -> f64,
    ) -> Self {
        let mut rows = Self {
            starts: vec![0],
            columns: Vec::new(),
            values: Vec::new(),
        };
        let laplacian = &operator.laplacian;
        for local in (0..column_of.len()).filter(|&local| column_of[local] == CONSTRAINED) {
            let root = resistance(local).sqrt();
            let beside = laplacian.neighbours(local).iter().zip(laplacian.weights(local));
            let entries = beside.filter(|_| root > 0.0).filter_map(|(&other, &weight)| {
                let column = column_of[other as usize];
                (column != CONSTRAINED).then(|| (column, root * weight * scale[column as usize]))
            });
            rows.push(entries);
        }
        for spring in 0..operator.springs.len() {
            let column = column_of[operator.springs.local(spring) as usize];
            let value = operator.springs.strength(spring).sqrt() * scale[column as usize];
            rows.push(std::iter::once((column, value)));
        }
        rows
    }

    /// The column of every entry, repeated as often as it occurs.
    pub fn columns(&self) -> impl Iterator<Item = u32> {
        self.columns.iter().copied()
    }

    /// The same rows over other columns: the new column of each entry, and its factor.
    pub fn moved(&self, to: impl Fn(u32) -> u32, factor: impl Fn(u32) -> f64) -> Self {
        let entries = self.columns.iter().zip(&self.values);
        Self {
            starts: self.starts.clone(),
            columns: self.columns.iter().map(|&column| to(column)).collect(),
            values: entries.map(|(&column, value)| value * factor(column)).collect(),
        }
    }

    /// Adds a row, if it has entries.
    fn push(&mut self, entries: impl Iterator<Item = (u32, f64)>) {
        let before = self.columns.len();
        for (column, value) in entries {
            self.columns.push(column);
            self.values.push(value);
        }
        if self.columns.len() > before {
            self.starts.push(self.columns.len());
        }
    }

    /// The number of rows.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The rows' products with each column of `x`.
    pub fn product<const K: usize>(&self, x: &[[f64; K]]) -> Vec<[f64; K]> {
        let row = |row: usize| {
            let mut sum = [0.0; K];
            for entry in self.starts[row]..self.starts[row + 1] {
                let (value, x) = (self.values[entry], &x[self.columns[entry] as usize]);
                for k in 0..K {
                    sum[k] += value * x[k];
                }
            }
            sum
        };
        (0..self.len()).into_par_iter().with_min_len(CHUNK).map(row).collect()
    }

    /// x ← x − rowsᵀ q.
    pub fn subtract_transposed<const K: usize>(&self, q: &[[f64; K]], x: &mut [[f64; K]]) {
        for (row, q) in q.iter().enumerate() {
            for entry in self.starts[row]..self.starts[row + 1] {
                let (value, x) = (self.values[entry], &mut x[self.columns[entry] as usize]);
                for k in 0..K {
                    x[k] -= value * q[k];
                }
            }
        }
    }
}
