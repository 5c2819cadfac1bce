//! Filters of handles' trajectories through a sequence.

use serde::{Deserialize, Serialize};

use super::edit_error::EditError;
use crate::document::HandleFilter;
use crate::filter_kind::{AMOUNT_RANGE, FilterKind, WIDTH_RANGE};

/// A filter of the trajectory of one handle.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FilterEntry {
    /// The handle's name. If it has a parent, its way relative to the parent is filtered.
    pub handle: String,
    /// The first and the last frame, which stay in place.
    pub span: [u32; 2],
    /// The effect.
    pub kind: FilterKind,
    /// The standard deviation of the Gaussian, in frames, from 0.1 to 1000.
    #[serde(default = "usual_width")]
    pub width: f64,
    /// The share of the filter, from 0 to 10.
    #[serde(default = "all_of_it")]
    pub amount: f64,
}

fn usual_width() -> f64 {
    2.0
}

fn all_of_it() -> f64 {
    1.0
}

impl FilterEntry {
    /// The filter of a document's handle with this name.
    pub(super) fn of(handle: &str, filter: &HandleFilter) -> Self {
        Self {
            handle: handle.to_owned(),
            span: filter.span.map(|frame| frame as u32),
            kind: filter.kind,
            width: filter.width,
            amount: filter.amount,
        }
    }

    /// The same for a document.
    pub(super) fn filter(&self) -> HandleFilter {
        HandleFilter {
            span: self.span.map(|frame| frame as usize),
            kind: self.kind,
            width: self.width,
            amount: self.amount,
        }
    }
}

/// Refuses numbers out of range and spans that end before they begin.
pub(super) fn check_filters(filters: &[FilterEntry]) -> Result<(), EditError> {
    for (place, filter) in filters.iter().enumerate() {
        let refuse = |member: &str, found: String, allowed: String| {
            Err(EditError::OutOfRange {
                place: format!("filter[{place}].{member}"),
                found,
                allowed,
            })
        };
        let numbers =
            |range: &std::ops::RangeInclusive<f64>| format!("a number from {} to {}", range.start(), range.end());
        let [first, last] = filter.span;
        if first > last {
            return refuse(
                "span",
                format!("[{first}, {last}]"),
                "a last frame from the first one on".to_owned(),
            );
        }
        if !WIDTH_RANGE.contains(&filter.width) {
            return refuse("width", filter.width.to_string(), numbers(&WIDTH_RANGE));
        }
        if !AMOUNT_RANGE.contains(&filter.amount) {
            return refuse("amount", filter.amount.to_string(), numbers(&AMOUNT_RANGE));
        }
    }
    Ok(())
}
