//! Eigenvectors of small symmetric matrices by Jacobi's rotations.

use glam::{DMat3, DVec3};

/// Entries beside the diagonal that are smaller than this are zero: squared, they are far below the rounding of entries
/// of about 1.
const NOTHING: f64 = 1e-30;

/// Diagonalises a symmetric matrix in place, whose largest entry is about 1; the columns of the result are its unit
/// eigenvectors.
pub(crate) fn jacobi<const N: usize>(matrix: &mut [[f64; N]; N]) -> [[f64; N]; N] {
    let mut vectors: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(i == j)));
    for _sweep in 0..16 {
        let mut is_diagonal = true;
        for p in 0..N - 1 {
            for q in p + 1..N {
                let own = matrix[p][q];
                if own.abs() < NOTHING {
                    continue;
                }
                is_diagonal = false;
                let theta = (matrix[q][q] - matrix[p][p]) / (2.0 * own);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = (t * t + 1.0).sqrt().recip();
                let s = t * c;
                matrix[p][p] -= t * own;
                matrix[q][q] += t * own;
                (matrix[p][q], matrix[q][p]) = (0.0, 0.0);
                for k in (0..N).filter(|k| *k != p && *k != q) {
                    let (a, b) = (matrix[k][p], matrix[k][q]);
                    let (a, b) = (c * a - s * b, s * a + c * b);
                    (matrix[k][p], matrix[k][q]) = (a, b);
                    (matrix[p][k], matrix[q][k]) = (a, b);
                }
                for row in vectors.iter_mut() {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
            }
        }
        if is_diagonal {
            break;
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
