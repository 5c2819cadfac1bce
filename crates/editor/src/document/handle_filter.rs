//! The filter of a handle's way through a sequence.

use crate::filter_kind::{AMOUNT_RANGE, FilterKind, WIDTH_RANGE};

/// The filter of the way of one handle.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct HandleFilter {
    /// The first and the last frame, which stay in place.
    pub span: [usize; 2],
    /// The effect.
    pub kind: FilterKind,
    /// The standard deviation of the Gaussian that tells quick from slow, in frames.
    pub width: f64,
    /// The share of the quick motions that is taken off or added.
    pub amount: f64,
}

impl HandleFilter {
    /// The least and the largest width, in frames.
    pub const WIDTH_RANGE: std::ops::RangeInclusive<f64> = WIDTH_RANGE;

    /// The least and the largest amount.
    pub const AMOUNT_RANGE: std::ops::RangeInclusive<f64> = AMOUNT_RANGE;

    /// A filter of all frames of a sequence, of which there are so many.
    pub fn of_all(count: usize) -> Self {
        Self {
            span: [0, count.saturating_sub(1)],
            kind: FilterKind::Smooth,
            width: 2.0,
            amount: 1.0,
        }
    }

    /// Returns true if an edit may have it in a sequence of so many frames.
    pub(crate) fn is_usable(&self, count: usize) -> bool {
        let [first, last] = self.span;
        let is_span = first <= last && last < count;
        is_span && WIDTH_RANGE.contains(&self.width) && AMOUNT_RANGE.contains(&self.amount)
    }
}
