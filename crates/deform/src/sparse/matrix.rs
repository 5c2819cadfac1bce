//! A symmetric matrix for the factorisation: compressed columns, scaled to a unit diagonal.

use rayon::prelude::*;

use crate::numerical::rows::CHUNK;

/// The scaled matrix S A S: the values on and below its diagonal.
#[derive(Debug)]
pub(crate) struct ScaledMatrix {
    /// S: one over the square root of A's diagonal, for each column.
    pub scale: Vec<f64>,
    /// Column starts of `lower_rows` and `lower_values`.
    pub lower_offsets: Vec<u32>,
    /// Rows on and below the diagonal; the diagonal comes first in its column.
    pub lower_rows: Vec<u32>,
    /// Values of `lower_rows`.
    pub lower_values: Vec<f64>,
}

/// No column: a constrained vertex.
pub(crate) const CONSTRAINED: u32 = u32::MAX;

impl ScaledMatrix {
    /// A column's rows on and below the diagonal, and their values.
    pub fn column(&self, column: usize) -> (&[u32], &[f64]) {
        let entries = self.lower_offsets[column] as usize..self.lower_offsets[column + 1] as usize;
        (&self.lower_rows[entries.clone()], &self.lower_values[entries])
    }

    /// Turns the values of A into those of S A S.
    pub fn scale_values(&mut self) {
        let scale = &self.scale;
        let mut columns = Vec::with_capacity(scale.len());
        let mut rest = self.lower_values.as_mut_slice();
        for bounds in self.lower_offsets.windows(2) {
            let (column, tail) = rest.split_at_mut((bounds[1] - bounds[0]) as usize);
            columns.push((&self.lower_rows[bounds[0] as usize..bounds[1] as usize], column));
            rest = tail;
        }
        columns
            .into_par_iter()
            .with_min_len(CHUNK)
            .enumerate()
            .for_each(|(column, (rows, values))| {
                for (&row, value) in rows.iter().zip(values) {
                    *value *= scale[column] * scale[row as usize];
                }
            });
    }
}
