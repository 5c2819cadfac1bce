//! The joint of a limb: the narrowest ring around the surface between a point and the body.
//!
//! Rings are level sets of the distance along the surface from the point ([`rings`]). The first ring that is narrower
//! than the rings before and after it gives the limb; its farthest point is the tip. Rings around the tip run straight
//! across the limb, while rings around a point on its side are askew. The narrowest ring around the tip gives a plane
//! across the limb, and the joint is the narrowest ring at an even distance from that plane.
//!
//! A person can ask for another joint than this guess. The candidates are the rings around the tip that are narrower
//! than their surroundings, and evenly spaced ones where there is none for a while ([`candidates`]).
//!
//! If a limb is as thick as it is long, no ring around a point on its side closes before it reaches the body. Rings
//! around a point on a head's side close, but around the face. In both cases the tip is the point farthest from the other
//! end of the surface whose way from there goes through the point ([`FarTips`]). If a point is the tip of a short limb (an
//! ear on a head), the rings around the point show it at once ([`candidates::is_tip`]).
//!
//! A point on a shoulder may be beyond the askew ring of its own joint; then the straight ring decides
//! ([`candidates::just_before`]). The head of a bust is larger than its body; then the neck between the surface's two ends
//! is the joint ([`candidates::neck`]).

mod candidates;
mod cut;
mod hunt;
mod level_set;
mod limb;
mod origin;
mod rings;
mod shape;

use glam::DVec3;

use self::hunt::Hunt;
pub use self::level_set::crossing as level_crossing;
pub use self::limb::{JOINT_RINGS, Joint};
pub use self::shape::Shape;
use crate::{Cancel, Cancelled};

/// The joint between a point in a triangle and the body, which has two fifths of the component's area or more, or less
/// if the limb is the head of a bust; `None`
/// if no ring around the point's side is clearly shorter than that of a disc, as on a ball or a sheet.
///
/// `up` chooses the joint that is so many candidates farther from the limb's tip than the guess, which is the first one
/// beyond the point. If there are fewer, the last one is taken, and [`Joint::up`] has its number; it is 0 if `up` is
/// negative.
///
/// # Errors
/// [`Cancelled`] soon after `cancel` is raised.
///
/// # Panics
/// If there is no such triangle.
pub fn joint_of(
    shape: &Shape<'_>,
    triangle: u32,
    point: DVec3,
    up: i32,
    cancel: &Cancel,
) -> Result<Option<Joint>, Cancelled> {
    Hunt::new(shape, triangle, point, cancel).joint(up)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests;
