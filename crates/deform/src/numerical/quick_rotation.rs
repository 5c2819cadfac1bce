//! The rotation R that maximises tr(Rᵀ S), by the characteristic polynomial of Horn's 4×4 matrix [The05].
//!
//! Its eigenvalues are σ₁ + σ₂ + σ₃, σ₁ − σ₂ − σ₃, −σ₁ + σ₂ − σ₃ and −σ₁ − σ₂ + σ₃, with the singular values of S, the
//! last one negative if S mirrors. The polynomial has no cubic term, and its others are sums over S, so that Newton's
//! method finds the largest eigenvalue from above without a rotation of the matrix: in a twentieth of the time that
//! Jacobi's method takes for all eigenvectors. Where the two largest ones are close, the vector is inaccurate or missing,
//! so the caller refines it and checks that it is the maximum.

use glam::{DMat3, DQuat};

use crate::numerical::horn::horn;

/// Newton's steps for the eigenvalue: each at least halves its distance from above, and the last ones square it.
const STEPS: u32 = 32;

/// The least cofactor of a sound eigenvector; the eigenvalues are about 1.
const SOUND: f64 = 1e-12;

/// The rotation for a finite `s` that is not zero; `None` if it is not unique, or nearly so.
pub(crate) fn quick_rotation(s: &DMat3) -> Option<DQuat> {
    let size = s.to_cols_array().into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let s = *s * size.recip();
    let square = s.to_cols_array().into_iter().map(|entry| entry * entry).sum::<f64>();
    let product = (s.transpose() * s).to_cols_array();
    let fourth = product.into_iter().map(|entry| entry * entry).sum::<f64>();
    // λ⁴ + c₂ λ² + c₁ λ + c₀.
    let (c2, c1, c0) = (-2.0 * square, -8.0 * s.determinant(), 2.0 * fourth - square * square);
    // No sum of the singular values is larger.
    let mut largest = (3.0 * square).sqrt();
    for _ in 0..STEPS {
        let value = ((largest * largest + c2) * largest + c1) * largest + c0;
        let slope = (4.0 * largest * largest + 2.0 * c2) * largest + c1;
        let step = value / slope;
        if step.is_nan() || step <= 1e-12 * largest {
            break;
        }
        largest -= step;
    }
    let mut n = horn(&s.transpose());
    for (k, row) in n.iter_mut().enumerate() {
        row[k] -= largest;
    }
    // The adjugate of a singular symmetric matrix is v vᵀ times a number.
    let best = (0..4).max_by(|a, b| cofactor(&n, *a, *a).abs().total_cmp(&cofactor(&n, *b, *b).abs()))?;
    let [w, x, y, z] = std::array::from_fn(|k| cofactor(&n, best, k));
    let vector = DQuat::from_xyzw(x, y, z, w);
    (vector.length() > SOUND).then(|| vector.normalize())
}

fn cofactor(n: &[[f64; 4]; 4], row: usize, column: usize) -> f64 {
    let others = |left_out: usize| -> [usize; 3] { std::array::from_fn(|k| if k < left_out { k } else { k + 1 }) };
    let (r, c) = (others(row), others(column));
    let m = |i: usize, j: usize| n[r[i]][c[j]];
    let minor = m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1)) - m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0))
        + m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
    if (row + column).is_multiple_of(2) {
        minor
    } else {
        -minor
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use super::*;
    use crate::numerical::rigid_fit::best_rotation;
    use crate::numerical::rotation::tests::STRETCHES;

    #[test]
    fn it_is_the_largest_eigenvector_also_of_flat_and_mirrored_matrices() {
        let turn = |k: u32| {
            let k = f64::from(k);
            DQuat::from_euler(glam::EulerRot::XYZ, 0.7 * k, 1.3 * k, 2.9 * k)
        };
        for stretches in STRETCHES {
            for k in 0..50 {
                let s = DMat3::from_quat(turn(k)) * DMat3::from_diagonal(stretches) * DMat3::from_quat(turn(k + 7));
                let (found, meant) = (quick_rotation(&s).unwrap(), best_rotation(&s.transpose()));
                let off = 1.0 - found.dot(meant).abs();
                assert!(off < 1e-9, "{stretches} {k}: {off:e}");
            }
        }
        // Every half turn is the best: tr(Rᵀ S) is 1.
        if let Some(found) = quick_rotation(&-DMat3::IDENTITY) {
            let r = DMat3::from_quat(found);
            assert!((1.0 + r.x_axis.x + r.y_axis.y + r.z_axis.z).abs() < 1e-6, "{found}");
        }
    }
}
