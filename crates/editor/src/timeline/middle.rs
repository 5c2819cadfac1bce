//! The middle of positions.

use glam::DVec3;

/// The mean of positions; the origin if there are none.
pub fn middle_of(positions: &[DVec3]) -> DVec3 {
    let origin = positions.first().copied().unwrap_or_default();
    let from_origin: DVec3 = positions.iter().map(|position| *position - origin).sum();
    origin + from_origin / positions.len().max(1) as f64
}
