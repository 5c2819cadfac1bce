//! Positions as stored.

use glam::{DAffine3, DVec3};

/// Equality of bits, so that a NaN equals itself and 0 differs from -0.
pub(crate) fn bit_equal(a: DVec3, b: DVec3) -> bool {
    a.to_array().map(f64::to_bits) == b.to_array().map(f64::to_bits)
}

/// A position in world space. Without a transform it is the stored one to the bit.
pub(crate) fn placed(transform: DAffine3, position: DVec3) -> DVec3 {
    match transform == DAffine3::IDENTITY {
        true => position,
        false => transform.transform_point3(position),
    }
}
