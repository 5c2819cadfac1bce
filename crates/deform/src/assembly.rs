//! The thin plate's matrix A = L M⁻¹ L on the solved vertices, straight into compressed columns.
//!
//! Column by column, each from its vertex's two-ring, with no triplets and nothing sorted: columns are computed apart
//! and stand in the order in which they are eliminated, so neither the order nor the number of threads shows. The
//! matrix is scaled symmetrically to a unit diagonal, which takes the units and most of the spread of triangle sizes
//! out of it.

use rayon::prelude::*;

use crate::Laplacian;
use crate::operators::CHUNK;

/// The scaled matrix S A S: the pattern above its diagonal and the values on and below it.
#[derive(Debug)]
pub(crate) struct PlateMatrix {
    /// S: one over the root of A's diagonal, one a column.
    pub scale: Vec<f64>,
    /// Column starts of `upper_rows`.
    pub upper_offsets: Vec<u32>,
    /// Rows strictly above the diagonal.
    pub upper_rows: Vec<u32>,
    /// Column starts of `lower_rows` and `lower_values`.
    pub lower_offsets: Vec<u32>,
    /// Rows on and below the diagonal; the diagonal comes first in its column.
    pub lower_rows: Vec<u32>,
    /// Values of `lower_rows`.
    pub lower_values: Vec<f64>,
}

/// No column: a constrained vertex.
pub(crate) const CONSTRAINED: u32 = u32::MAX;

/// Assembles the plate over the local vertices `columns`, in that order; `column_of` is the inverse table, with
/// [`CONSTRAINED`] where a local vertex has no column.
pub(crate) fn assemble_plate(laplacian: &Laplacian, columns: &[u32], column_of: &[u32]) -> PlateMatrix {
    let scale: Vec<f64> = columns
        .par_iter()
        .with_min_len(CHUNK)
        .map(|&vertex| {
            let square: f64 = laplacian_row(laplacian, vertex)
                .map(|(k, weight)| laplacian.inverse_areas()[k as usize] * weight * weight)
                .sum();
            // A vertex without any weight has an empty row: leave it to the factorisation to say so.
            if square > 0.0 { square.sqrt().recip() } else { 1.0 }
        })
        .collect();
    let chunks: Vec<Chunk> = (0..columns.len().div_ceil(CHUNK))
        .into_par_iter()
        .map_init(
            || vec![0; column_of.len()],
            |slots, chunk| {
                let range = chunk * CHUNK..((chunk + 1) * CHUNK).min(columns.len());
                assemble_chunk(laplacian, columns, column_of, &scale, range, slots)
            },
        )
        .collect();
    let mut plate = PlateMatrix {
        scale,
        upper_offsets: vec![0],
        upper_rows: Vec::with_capacity(chunks.iter().map(|chunk| chunk.upper_rows.len()).sum()),
        lower_offsets: vec![0],
        lower_rows: Vec::with_capacity(chunks.iter().map(|chunk| chunk.lower_rows.len()).sum()),
        lower_values: Vec::with_capacity(chunks.iter().map(|chunk| chunk.lower_rows.len()).sum()),
    };
    let (mut upper_end, mut lower_end) = (0, 0);
    for chunk in chunks {
        for (upper, lower) in chunk.counts {
            upper_end += upper;
            lower_end += lower;
            plate.upper_offsets.push(upper_end);
            plate.lower_offsets.push(lower_end);
        }
        plate.upper_rows.extend(chunk.upper_rows);
        plate.lower_rows.extend(chunk.lower_rows);
        plate.lower_values.extend(chunk.lower_values);
    }
    plate
}

#[derive(Default)]
struct Chunk {
    /// Entries above the diagonal, and on and below it, of each column.
    counts: Vec<(u32, u32)>,
    upper_rows: Vec<u32>,
    lower_rows: Vec<u32>,
    lower_values: Vec<f64>,
}

/// `slots` is all zero before and after, one a local vertex.
fn assemble_chunk(
    laplacian: &Laplacian,
    columns: &[u32],
    column_of: &[u32],
    scale: &[f64],
    range: std::ops::Range<usize>,
    slots: &mut [u32],
) -> Chunk {
    let mut chunk = Chunk::default();
    // The column's entries as they are met; `slots` holds one more than a local vertex's place among them.
    let mut entries: Vec<(u32, f64)> = Vec::with_capacity(64);
    for column in range {
        let vertex = columns[column];
        for (middle, weight) in laplacian_row(laplacian, vertex) {
            let weight = weight * laplacian.inverse_areas()[middle as usize];
            for (far, far_weight) in laplacian_row(laplacian, middle) {
                if column_of[far as usize] == CONSTRAINED {
                    continue;
                }
                let slot = &mut slots[far as usize];
                if *slot == 0 {
                    entries.push((far, 0.0));
                    *slot = entries.len() as u32;
                }
                entries[*slot as usize - 1].1 += weight * far_weight;
            }
        }
        let before = (chunk.upper_rows.len(), chunk.lower_rows.len());
        // The diagonal is met first: the column's own vertex is its first middle and that one's first neighbour.
        for (far, value) in entries.drain(..) {
            slots[far as usize] = 0;
            let row = column_of[far as usize];
            if (row as usize) < column {
                chunk.upper_rows.push(row);
            } else {
                chunk.lower_rows.push(row);
                chunk.lower_values.push(value * scale[column] * scale[row as usize]);
            }
        }
        chunk.counts.push((
            (chunk.upper_rows.len() - before.0) as u32,
            (chunk.lower_rows.len() - before.1) as u32,
        ));
    }
    chunk
}

/// The entries of L's row, the diagonal first.
fn laplacian_row(laplacian: &Laplacian, vertex: u32) -> impl Iterator<Item = (u32, f64)> + '_ {
    let (neighbours, weights) = (
        laplacian.neighbours(vertex as usize),
        laplacian.weights(vertex as usize),
    );
    let diagonal = -weights.iter().sum::<f64>();
    std::iter::once((vertex, diagonal)).chain(neighbours.iter().copied().zip(weights.iter().copied()))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::{CONSTRAINED, assemble_plate};
    use crate::Laplacian;
    use pliant_mesh::{Cancel, Model, Progress, WeldOptions, shapes};

    #[test]
    fn the_matrix_is_the_operator_column_by_column() {
        let drawn = shapes::torus(9, 7);
        let model = Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap();
        let count = model.surface.positions.len();
        let stiffness: Vec<f64> = (0..count).map(|i| 1.0 + (i % 5) as f64).collect();
        let laplacian = Laplacian::of(&model.surface, &model.topology, &stiffness);
        let columns: Vec<u32> = (0..count as u32).rev().filter(|v| v % 7 != 0).collect();
        let mut column_of = vec![CONSTRAINED; count];
        for (column, &vertex) in columns.iter().enumerate() {
            column_of[vertex as usize] = column as u32;
        }
        let plate = assemble_plate(&laplacian, &columns, &column_of);
        for (column, &vertex) in columns.iter().enumerate() {
            let mut unit = vec![[0.0]; count];
            unit[vertex as usize] = [1.0];
            let inner = laplacian.per_area(&unit);
            let entries = plate.lower_offsets[column] as usize..plate.lower_offsets[column + 1] as usize;
            let mut seen = 0;
            for entry in entries {
                let row = plate.lower_rows[entry] as usize;
                let expected = laplacian.row(columns[row] as usize, &inner)[0] * plate.scale[row] * plate.scale[column];
                assert!((plate.lower_values[entry] - expected).abs() < 1e-13, "{row} {column}");
                seen += 1;
            }
            let diagonal = plate.lower_values[plate.lower_offsets[column] as usize];
            assert!((diagonal - 1.0).abs() < 1e-13);
            let filled = (0..columns.len())
                .filter(|&row| row >= column && laplacian.row(columns[row] as usize, &inner)[0].abs() > 1e-12)
                .count();
            assert!(filled <= seen);
        }
        assert_eq!(plate.upper_rows.len() + columns.len(), plate.lower_rows.len());
    }
}
