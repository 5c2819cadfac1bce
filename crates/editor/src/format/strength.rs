//! The range of the shown share of an edit.

use super::field::FieldKind;

/// The smallest and the largest shown share of an edit.
pub const STRENGTH_RANGE: std::ops::RangeInclusive<f64> = 0.0..=1.0;

/// The range of a strength.
pub(crate) fn strength_kind() -> FieldKind {
    FieldKind {
        name: "a strength",
        range: STRENGTH_RANGE,
        may_be_rigid: false,
    }
}
