//! Eigenvectors of small symmetric matrices by Jacobi's rotations.

use glam::{DMat3, DVec3};

/// Diagonalises a symmetric matrix in place; the columns of the result are its unit eigenvectors.
pub(crate) fn jacobi<const N: usize>(matrix: &mut [[f64; N]; N]) -> [[f64; N]; N] {
    let mut vectors: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(i == j)));
    for _sweep in 0..16 {
        for p in 0..N - 1 {
            for q in p + 1..N {
                if matrix[p][q].abs() < 1e-300 {
                    continue;
                }
                let theta = (matrix[q][q] - matrix[p][p]) / (2.0 * matrix[p][q]);
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = t.hypot(1.0).recip();
                let s = t * c;
                for row in matrix.iter_mut() {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                for k in 0..N {
                    let (a, b) = (matrix[p][k], matrix[q][k]);
                    (matrix[p][k], matrix[q][k]) = (c * a - s * b, s * a + c * b);
                }
                for row in vectors.iter_mut() {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
            }
        }
    }
    vectors
}

/// The unit eigenvectors of a symmetric matrix as columns, and its eigenvalues.
pub(crate) fn eigenvectors(matrix: &DMat3) -> (DMat3, DVec3) {
    let largest = matrix.to_cols_array().into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return (DMat3::IDENTITY, DVec3::ZERO);
    }
    let mut rows: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| matrix.col(j)[i] / largest));
    let vectors = jacobi(&mut rows);
    let column = |k: usize| DVec3::new(vectors[0][k], vectors[1][k], vectors[2][k]);
    let values = DVec3::new(rows[0][0], rows[1][1], rows[2][2]) * largest;
    (DMat3::from_cols(column(0), column(1), column(2)), values)
}
