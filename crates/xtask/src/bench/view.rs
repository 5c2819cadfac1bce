//! The view: frames on the processor's and on the device's side, moved shapes, answers to the pointer, by the example
//! `view_times` of `app`.

use super::Scale;
use super::table::{Row, measured};

/// Rows for each size: the largest, too, since what a large scan costs is what is asked.
pub fn rows(_: Scale) -> Result<Vec<Row>, String> {
    let sizes = [10_000, 100_000, 200_000, 1_000_000, 5_000_000].map(|triangles: usize| triangles.to_string());
    measured("pliant-app", "view_times", &sizes)
}
