//! Limits to the bends of a chain's joints.

use std::f64::consts::PI;

use glam::DVec3;

/// The least and the most bend of a joint in radians, 0 to π: the angle between the segments before and after it, 0 where
/// they are one straight line.
pub type BendRange = [f64; 2];

/// The bends of a joint without limits.
pub const FREE_BEND: BendRange = [0.0, PI];

/// The limits of a chain's joints.
#[derive(Clone, Copy, Debug, Default)]
pub struct JointLimits<'a> {
    /// A range for each point of the chain; none at all for a chain without limits. That of the last point limits nothing.
    pub bends: &'a [BendRange],
    /// The direction in which the segment before the first point goes on, if there is one: it limits the first joint.
    pub before: Option<DVec3>,
}

impl JointLimits<'_> {
    /// Returns true if no joint has limits.
    pub(super) fn are_free(&self) -> bool {
        self.bends.iter().all(|range| *range == FREE_BEND)
    }

    /// The range of a joint.
    pub(super) fn range(&self, joint: usize) -> BendRange {
        self.bends.get(joint).copied().unwrap_or(FREE_BEND)
    }

    /// The direction nearest to the unit vector `direction` that a joint allows after a segment in the direction `before`.
    pub fn allowed(&self, joint: usize, before: DVec3, direction: DVec3) -> DVec3 {
        let Some([least, most]) = self.bends.get(joint) else {
            return direction;
        };
        let (along, bend) = (before.normalize_or(DVec3::X), before.angle_between(direction));
        if (*least..=*most).contains(&bend) {
            return direction;
        }
        // A straight or a folded joint may bend towards any side. The first rejection from a nearly parallel direction is
        // not quite perpendicular.
        let across = direction.reject_from_normalized(along).try_normalize();
        let across = across.and_then(|across| across.reject_from_normalized(along).try_normalize());
        let across = across.unwrap_or_else(|| along.any_orthonormal_vector());
        let (sine, cosine) = bend.clamp(*least, *most).sin_cos();
        along * cosine + across * sine
    }
}
