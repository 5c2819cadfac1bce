//! The bi-Laplacian's matrix A on the solved vertices, straight into compressed columns.
//!
//! Each column is computed independently from its vertex's n-ring, without triplets and without sorting, and stored in
//! the order of elimination, so the result does not depend on the number of threads. The matrix is scaled symmetrically
//! to a unit diagonal, which removes the units and most of the spread of triangle sizes.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use rayon::prelude::*;

use crate::Laplacian;
use crate::budget::{Budget, Limit, filled};
use crate::numerical::rows::CHUNK;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::{CONSTRAINED, ScaledMatrix};
use crate::systems::hubs::Hubs;
use crate::systems::operator::BilaplacianOperator;

/// Assembles the matrix over the local vertices `columns`, in that order; `column_of` is the inverse table, with
/// [`CONSTRAINED`] for a local vertex without a column. The curvature at `hubs` is left to their correction.
///
/// # Errors
/// If its entries exceed the budget or the machine's memory.
pub(crate) fn assemble_bilaplacian(
    operator: &BilaplacianOperator,
    columns: &[u32],
    column_of: &[u32],
    hubs: &Hubs,
    budget: Budget,
) -> Result<ScaledMatrix, FactorError> {
    // The chunks and the matrix exist at once for a while. The matrix's offsets have 32 bits.
    let most = (budget.bytes / (2 * ENTRY)).min(u64::from(u32::MAX));
    let entries = AtomicU64::new(0);
    let chunks: Vec<Chunk> = (0..columns.len().div_ceil(CHUNK))
        .into_par_iter()
        .map_init(
            || Expansion::new(column_of.len()),
            |expansion, chunk| {
                let range = chunk * CHUNK..((chunk + 1) * CHUNK).min(columns.len());
                assemble_chunk(operator, columns, column_of, hubs, range, expansion, &|count| {
                    entries.fetch_add(count, Relaxed) + count <= most
                })
            },
        )
        .collect::<Option<_>>()
        .ok_or(FactorError::Budget(Limit::Bytes(budget.bytes)))?;
    let scale: Vec<f64> = chunks.iter().flat_map(|chunk| chunk.scale.iter().copied()).collect();
    let mut lower_offsets = Vec::with_capacity(columns.len() + 1);
    lower_offsets.push(0);
    let mut end = 0;
    for count in chunks.iter().flat_map(|chunk| &chunk.counts) {
        end += count;
        lower_offsets.push(end);
    }
    let (mut lower_rows, mut lower_values) = (filled(0, end as usize)?, filled(0.0, end as usize)?);
    let (mut rows_left, mut values_left) = (lower_rows.as_mut_slice(), lower_values.as_mut_slice());
    let mut targets = Vec::with_capacity(chunks.len());
    for chunk in &chunks {
        let (rows, rows_behind) = rows_left.split_at_mut(chunk.lower_rows.len());
        let (values, values_behind) = values_left.split_at_mut(chunk.lower_values.len());
        targets.push((rows, values));
        (rows_left, values_left) = (rows_behind, values_behind);
    }
    targets
        .into_par_iter()
        .zip(&chunks)
        .for_each(|((rows, values), chunk)| {
            rows.copy_from_slice(&chunk.lower_rows);
            let mut first = 0;
            for (&own, &count) in chunk.scale.iter().zip(&chunk.counts) {
                let entries = first..first + count as usize;
                let found = chunk.lower_rows[entries.clone()]
                    .iter()
                    .zip(&chunk.lower_values[entries.clone()]);
                for (target, (&row, &value)) in values[entries.clone()].iter_mut().zip(found) {
                    *target = value * (own * scale[row as usize]);
                }
                first = entries.end;
            }
        });
    Ok(ScaledMatrix {
        scale,
        lower_offsets,
        lower_rows,
        lower_values,
    })
}

/// Bytes of an entry: its row and its value.
const ENTRY: u64 = 12;

#[derive(Default)]
struct Chunk {
    /// One over the square root of each column's diagonal.
    scale: Vec<f64>,
    /// The entries on and below the diagonal of each column.
    counts: Vec<u32>,
    lower_rows: Vec<u32>,
    lower_values: Vec<f64>,
}

/// `None` as soon as `fits` refuses this many more entries.
fn assemble_chunk(
    operator: &BilaplacianOperator,
    columns: &[u32],
    column_of: &[u32],
    hubs: &Hubs,
    range: std::ops::Range<usize>,
    expansion: &mut Expansion,
    fits: &impl Fn(u64) -> bool,
) -> Option<Chunk> {
    let mut chunk = Chunk::default();
    let solved = |vertex: u32| column_of[vertex as usize] != CONSTRAINED;
    for column in range {
        let before = chunk.lower_rows.len();
        // The diagonal comes first: each walk starts at the column's own vertex.
        for &(far, value) in expansion.column(operator, hubs, columns[column], solved) {
            let row = column_of[far as usize];
            if row as usize >= column {
                chunk.lower_rows.push(row);
                chunk.lower_values.push(value);
            }
        }
        let count = chunk.lower_rows.len() - before;
        if !fits(count as u64) {
            return None;
        }
        chunk.counts.push(count as u32);
        // A vertex without any weight has an empty row; the factorisation refuses it.
        let diagonal = chunk.lower_values[before];
        chunk
            .scale
            .push(if diagonal > 0.0 { diagonal.sqrt().recip() } else { 1.0 });
    }
    Some(chunk)
}

/// The entries of one column during its assembly.
struct Expansion {
    /// One more than a local vertex's place among `entries`; 0 if it has none.
    slots: Vec<u32>,
    entries: Vec<(u32, f64)>,
    inner: Vec<(u32, f64)>,
}

impl Expansion {
    fn new(vertex_count: usize) -> Self {
        Self {
            slots: vec![0; vertex_count],
            entries: Vec::with_capacity(64),
            inner: Vec::with_capacity(64),
        }
    }

    /// The entries of A's column on the solved vertices, the diagonal first.
    fn column(
        &mut self,
        operator: &BilaplacianOperator,
        hubs: &Hubs,
        vertex: u32,
        solved: impl Fn(u32) -> bool,
    ) -> &[(u32, f64)] {
        let laplacian = &operator.laplacian;
        self.entries.clear();
        if operator.power == 1 {
            let factor = operator.stretching + operator.bending;
            self.add(laplacian, vertex, factor, &solved);
            return self.finished(operator, vertex);
        }
        // M⁻¹ P, then at order 3 M⁻¹ P M⁻¹ P, of the column's unit vector, with P = −L; no entry is dropped yet.
        self.add(laplacian, vertex, operator.bending, |_| true);
        if operator.power == 3 {
            self.step(operator.middle(), hubs);
        }
        self.close();
        std::mem::swap(&mut self.entries, &mut self.inner);
        self.entries.clear();
        if hubs.contains(vertex) {
            self.put(vertex, 0.0);
        }
        if operator.stretching > 0.0 {
            let stretched = operator.stretched.as_ref().unwrap_or(laplacian);
            self.add(stretched, vertex, operator.stretching, &solved);
        }
        self.spread(laplacian, hubs, |cell| operator.cell_stiffness(cell), &solved);
        self.add_natural(operator, vertex, &solved);
        for (far, value) in hubs.stand_in_column(vertex) {
            if solved(far) {
                self.put(far, value);
            }
        }
        self.finished(operator, vertex)
    }

    /// The column's entries with its spring on the diagonal, which comes first.
    fn finished(&mut self, operator: &BilaplacianOperator, vertex: u32) -> &[(u32, f64)] {
        self.close();
        if let Some((_, diagonal)) = self.entries.first_mut() {
            *diagonal += operator.springs.diagonal(vertex);
        }
        &self.entries
    }

    /// entries ← P M⁻¹ entries.
    fn step(&mut self, laplacian: &Laplacian, hubs: &Hubs) {
        self.close();
        std::mem::swap(&mut self.entries, &mut self.inner);
        self.entries.clear();
        self.spread(laplacian, hubs, |_| 1.0, |_| true);
    }

    /// entries += P s M⁻¹ inner, with s the local vertex's `stiffness`, and nothing through a hub.
    fn spread(
        &mut self,
        laplacian: &Laplacian,
        hubs: &Hubs,
        stiffness: impl Fn(usize) -> f64,
        keep: impl Fn(u32) -> bool,
    ) {
        for place in 0..self.inner.len() {
            let (middle, value) = self.inner[place];
            if hubs.contains(middle) {
                continue;
            }
            self.add(
                laplacian,
                middle,
                value * stiffness(middle as usize) * laplacian.inverse_areas()[middle as usize],
                &keep,
            );
        }
    }

    /// entries += the natural term's column of `vertex`.
    fn add_natural(&mut self, operator: &BilaplacianOperator, vertex: u32, keep: impl Fn(u32) -> bool) {
        let (Some(natural), laplacian) = (&operator.natural, &operator.laplacian) else {
            return;
        };
        let (hessian, own) = (&natural.hessian, vertex as usize);
        let beside = laplacian
            .neighbours(own)
            .iter()
            .copied()
            .zip(hessian.back(own).iter().copied());
        for (middle, [a, b]) in std::iter::once((vertex, hessian.diagonal(own))).chain(beside) {
            let (middle, density) = (middle as usize, natural.density(laplacian, middle as usize));
            if density == 0.0 {
                continue;
            }
            let ring = laplacian
                .neighbours(middle)
                .iter()
                .copied()
                .zip(hessian.own(middle).iter().copied());
            for (far, [p, q]) in std::iter::once((middle as u32, hessian.diagonal(middle))).chain(ring) {
                if keep(far) {
                    self.put(far, density * (a * p + b * q));
                }
            }
        }
    }

    /// entries += factor · P's column of `vertex`.
    fn add(&mut self, laplacian: &Laplacian, vertex: u32, factor: f64, keep: impl Fn(u32) -> bool) {
        for (far, weight) in stiffness_row(laplacian, vertex) {
            if !keep(far) {
                continue;
            }
            self.put(far, factor * weight);
        }
    }

    /// entries += value at a local vertex.
    fn put(&mut self, far: u32, value: f64) {
        let slot = &mut self.slots[far as usize];
        if *slot == 0 {
            self.entries.push((far, 0.0));
            *slot = self.entries.len() as u32;
        }
        self.entries[*slot as usize - 1].1 += value;
    }

    /// Clears the entries.
    fn close(&mut self) {
        for &(vertex, _) in &self.entries {
            self.slots[vertex as usize] = 0;
        }
    }
}

/// The entries of −L's row, the diagonal first.
fn stiffness_row(laplacian: &Laplacian, vertex: u32) -> impl Iterator<Item = (u32, f64)> + '_ {
    let (neighbours, weights) = (
        laplacian.neighbours(vertex as usize),
        laplacian.weights(vertex as usize),
    );
    let diagonal = weights.iter().sum::<f64>();
    let others = neighbours.iter().zip(weights).map(|(&other, &weight)| (other, -weight));
    std::iter::once((vertex, diagonal)).chain(others)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::assemble_bilaplacian;
    use crate::sparse::matrix::CONSTRAINED;
    use crate::systems::hubs::Hubs;
    use crate::systems::operator::BilaplacianOperator;
    use crate::systems::plate_energy::PlateEnergy;
    use crate::{Budget, Laplacian};
    use pliant_mesh::shapes;

    fn matches_its_operator(energy: PlateEnergy) {
        let model = shapes::model(shapes::torus(9, 7));
        let count = model.surface.positions.len();
        let stiffness: Vec<f64> = (0..count).map(|i| 1.0 + (i % 5) as f64).collect();
        let stiff = || Some(Laplacian::of(&model.surface, &model.topology, &stiffness));
        let plain = Laplacian::of(&model.surface, &model.topology, &vec![1.0; count]);
        let mut operator = BilaplacianOperator::new(plain, energy, 3.0);
        match energy.power {
            1 => {}
            2 => operator.cell_stiffness.clone_from(&stiffness),
            _ => operator.middle = stiff(),
        }
        operator.stretched = stiff().filter(|_| operator.power > 1 && operator.stretching > 0.0);
        let columns: Vec<u32> = (0..count as u32).rev().filter(|v| v % 7 != 0).collect();
        let mut column_of = vec![CONSTRAINED; count];
        for (column, &vertex) in columns.iter().enumerate() {
            column_of[vertex as usize] = column as u32;
        }
        let matrix =
            assemble_bilaplacian(&operator, &columns, &column_of, &Hubs::default(), Budget::default()).unwrap();
        for (column, &vertex) in columns.iter().enumerate() {
            let mut unit = vec![[0.0]; count];
            unit[vertex as usize] = [1.0];
            let potential = operator.potential(&unit);
            let entries = matrix.lower_offsets[column] as usize..matrix.lower_offsets[column + 1] as usize;
            let mut seen = 0;
            for entry in entries {
                let row = matrix.lower_rows[entry] as usize;
                let expected =
                    operator.force(columns[row] as usize, &potential)[0] * matrix.scale[row] * matrix.scale[column];
                assert!((matrix.lower_values[entry] - expected).abs() < 1e-13, "{row} {column}");
                seen += 1;
            }
            let diagonal = matrix.lower_values[matrix.lower_offsets[column] as usize];
            assert!((diagonal - 1.0).abs() < 1e-13);
            let filled = (0..columns.len())
                .filter(|&row| {
                    let force = operator.force(columns[row] as usize, &potential)[0];
                    row >= column && (force * matrix.scale[row] * matrix.scale[column]).abs() > 1e-12
                })
                .count();
            assert!(filled <= seen);
        }
    }

    #[test]
    fn the_matrix_is_the_operator_column_by_column() {
        for power in [1, 2, 3] {
            for stretching in [0.0, 40.0] {
                matches_its_operator(PlateEnergy {
                    stretching,
                    ..PlateEnergy::of_power(power)
                });
            }
        }
    }
}
