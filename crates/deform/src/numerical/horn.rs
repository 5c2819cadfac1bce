//! Horn's symmetric 4×4 matrix [Hor87].

use glam::DMat3;

/// The matrix N with qᵀ N q = tr(R S) for the rotation R of a unit quaternion q = w, x, y, z, S = `covariance` = Σ from
/// toᵀ.
pub(crate) fn horn(covariance: &DMat3) -> [[f64; 4]; 4] {
    let s = |row: usize, column: usize| covariance.col(column)[row];
    let (x, y, z) = (s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0));
    [
        [s(0, 0) + s(1, 1) + s(2, 2), x, y, z],
        [x, s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2)],
        [y, s(0, 1) + s(1, 0), s(1, 1) - s(0, 0) - s(2, 2), s(1, 2) + s(2, 1)],
        [z, s(2, 0) + s(0, 2), s(1, 2) + s(2, 1), s(2, 2) - s(0, 0) - s(1, 1)],
    ]
}
