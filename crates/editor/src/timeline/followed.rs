//! A body followed through the frames of a sequence.

use glam::DVec3;

/// The body in one frame.
#[derive(Clone, PartialEq, Debug)]
pub struct FollowedFrame {
    /// The middle of its surface vertices, in world space.
    pub middle: DVec3,
}

/// The mean of positions, of which there is one at least.
pub fn middle_of(positions: &[DVec3]) -> DVec3 {
    let origin = positions.first().copied().unwrap_or_default();
    let from_origin: DVec3 = positions.iter().map(|position| *position - origin).sum();
    origin + from_origin / positions.len().max(1) as f64
}
