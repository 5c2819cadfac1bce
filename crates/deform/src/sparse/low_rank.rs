//! A system that is the sum of a factored sparse matrix and a correction of low rank: A = B + U C Uᵀ.
//!
//! A⁻¹ = B⁻¹ − Z N Uᵀ B⁻¹ with Z = B⁻¹ U and N = (1 + C Uᵀ Z)⁻¹ C (Sherman, Morrison & Woodbury), so that a solve with
//! A is one with B and two products with tall matrices whose columns number the correction's rank.

use rayon::prelude::*;

use crate::budget::filled;
use crate::numerical::rows::CHUNK;
use crate::sparse::cholesky::Factor;
use crate::sparse::factor_error::FactorError;

/// A sparse column: rows and their values.
pub(crate) type SparseVector = Vec<(u32, f64)>;

/// The correction that turns a solution with B into one with A.
#[derive(Debug)]
pub(crate) struct LowRank {
    /// The columns of U.
    vectors: Vec<SparseVector>,
    /// Z, row by row.
    solved: Vec<f64>,
    /// N, row by row.
    inner: Vec<f64>,
}

impl LowRank {
    /// The correction for the factored B, the columns of U and C, row by row.
    ///
    /// # Errors
    /// [`FactorError::Memory`]; [`FactorError::Pivot`] if A is singular to the last digit, with one of U's rows.
    pub fn of(factor: &Factor, vectors: Vec<SparseVector>, c: &[f64]) -> Result<Self, FactorError> {
        let (count, rank) = (factor.column_count(), vectors.len());
        let mut solved = filled(0.0, count * rank)?;
        for (group, own) in vectors.chunks(4).enumerate() {
            let mut x = filled([0.0; 4], count)?;
            for (k, vector) in own.iter().enumerate() {
                for &(row, value) in vector {
                    x[row as usize][k] += value;
                }
            }
            factor.solve(&mut x);
            for (row, x) in solved.chunks_exact_mut(rank).zip(&x) {
                row[4 * group..4 * group + own.len()].copy_from_slice(&x[..own.len()]);
            }
        }
        // 1 + C Y with Y = Uᵀ Z, beside C.
        let y: Vec<Vec<f64>> = vectors
            .iter()
            .map(|vector| {
                let mut sums = vec![0.0; rank];
                for &(row, value) in vector {
                    let own = &solved[row as usize * rank..(row as usize + 1) * rank];
                    sums.iter_mut().zip(own).for_each(|(sum, z)| *sum += value * z);
                }
                sums
            })
            .collect();
        let matrix = (0..rank)
            .map(|i| {
                let entry = |j: usize| {
                    let product: f64 = (0..rank).map(|k| c[i * rank + k] * y[k][j]).sum();
                    product + f64::from(u8::from(i == j))
                };
                (0..rank)
                    .map(entry)
                    .chain(c[i * rank..(i + 1) * rank].iter().copied())
                    .collect()
            })
            .collect();
        let first = vectors.first().and_then(|vector| vector.first());
        let singular = FactorError::Pivot(first.map_or(0, |&(row, _)| row as usize));
        let inner = solve_dense(matrix).ok_or(singular)?;
        // Symmetric except for rounding; conjugate gradients need exact symmetry.
        let inner = (0..rank * rank)
            .map(|place| 0.5 * (inner[place / rank][place % rank] + inner[place % rank][place / rank]))
            .collect();
        Ok(Self { vectors, solved, inner })
    }

    /// The number of stored entries.
    pub fn stored(&self) -> usize {
        self.solved.len() + self.inner.len()
    }

    /// The number of entries that a correction of this rank stores over `count` columns.
    pub fn stored_at_rank(count: usize, rank: usize) -> usize {
        rank.saturating_mul(count.saturating_add(rank))
    }

    /// Turns x = B⁻¹ b into A⁻¹ b.
    pub fn correct<const K: usize>(&self, x: &mut [[f64; K]]) {
        let rank = self.vectors.len();
        let products: Vec<[f64; K]> = self
            .vectors
            .iter()
            .map(|vector| {
                let mut sum = [0.0; K];
                for &(row, value) in vector {
                    let own = x[row as usize];
                    (0..K).for_each(|k| sum[k] += value * own[k]);
                }
                sum
            })
            .collect();
        let shares: Vec<[f64; K]> = self
            .inner
            .chunks_exact(rank)
            .map(|row| std::array::from_fn(|k| row.iter().zip(&products).map(|(n, t)| n * t[k]).sum()))
            .collect();
        x.par_iter_mut()
            .zip(self.solved.par_chunks_exact(rank))
            .with_min_len(CHUNK)
            .for_each(|(x, row)| {
                for (z, share) in row.iter().zip(&shares) {
                    (0..K).for_each(|k| x[k] -= z * share[k]);
                }
            });
    }
}

/// A⁻¹ B of the rows (A B), by elimination with partial pivoting; `None` if A is singular or not finite.
fn solve_dense(mut rows: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
    let count = rows.len();
    for step in 0..count {
        let pivot = (step..count).max_by(|&a, &b| rows[a][step].abs().total_cmp(&rows[b][step].abs()))?;
        rows.swap(step, pivot);
        let inverse = rows[step][step].recip();
        if !inverse.is_finite() {
            return None;
        }
        rows[step].iter_mut().skip(step).for_each(|value| *value *= inverse);
        let own = rows[step].clone();
        for (other, row) in rows.iter_mut().enumerate() {
            let factor = row[step];
            if other != step && factor != 0.0 {
                row.iter_mut()
                    .zip(&own)
                    .skip(step)
                    .for_each(|(value, own)| *value -= factor * own);
            }
        }
    }
    let is_finite = rows.iter().flatten().all(|value| value.is_finite());
    is_finite.then(|| rows.into_iter().map(|row| row[count..].to_vec()).collect())
}

#[cfg(test)]
mod tests {
    use super::solve_dense;

    #[test]
    fn a_dense_system_is_solved_whatever_its_signs_and_a_singular_one_refused() {
        let rows = vec![
            vec![0.0, 2.0, 1.0, 5.0],
            vec![-1.0, 0.5, 0.0, 2.0],
            vec![3.0, 0.0, -2.0, 1.0],
        ];
        let solved = solve_dense(rows.clone()).unwrap_or_default();
        for row in &rows {
            let product: f64 = (0..3).map(|k| row[k] * solved[k][0]).sum();
            assert!((product - row[3]).abs() < 1e-12);
        }
        assert_eq!(solve_dense(vec![vec![1.0, 2.0, 1.0], vec![2.0, 4.0, 1.0]]), None);
    }
}
