//! The view: CPU and GPU time of frames, shape updates and picks, with the example `view_times` of `app`.

use super::scale::Scale;
use super::table::{Row, measured};

/// Rows for each size, including the largest, because large scans matter most.
pub fn rows(_: Scale) -> Result<Vec<Row>, String> {
    let sizes = [10_000, 100_000, 200_000, 1_000_000, 5_000_000].map(|triangles: usize| triangles.to_string());
    measured("pliant-app", "view_times", &sizes)
}
