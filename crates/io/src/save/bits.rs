//! Positions as stored.

use glam::DVec3;

/// Equality of bits, so that a NaN equals itself and 0 differs from -0.
pub(crate) fn bit_equal(a: DVec3, b: DVec3) -> bool {
    a.to_array().map(f64::to_bits) == b.to_array().map(f64::to_bits)
}
