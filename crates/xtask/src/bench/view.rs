//! The view: frames on the processor's and on the device's side, moved shapes, answers to the pointer, by the example
//! `view_times` of `app`.

use super::Scale;
use super::table::{Row, measured};

/// Rows for each size.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    let sizes: &[usize] = match scale {
        Scale::Usual => &[10_000, 100_000, 200_000, 1_000_000],
        Scale::Full => &[10_000, 100_000, 200_000, 1_000_000, 5_000_000],
    };
    let mut rows = Vec::new();
    for triangles in sizes {
        rows.extend(measured("pliant-app", "view_times", &[triangles.to_string()])?);
    }
    Ok(rows)
}
