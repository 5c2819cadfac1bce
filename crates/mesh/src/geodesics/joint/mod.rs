//! The joint of a limb: the narrowest ring around the surface between a point and the body.
//!
//! Rings are level sets of the distance along the surface from the point ([`rings`]). The first ring that is narrower
//! than the rings before and after it gives the limb; its farthest point is the tip. Rings around the tip run straight
//! across the limb, while rings around a point on its side are askew. The narrowest ring around the tip gives a plane
//! across the limb, and the joint is the narrowest ring at an even distance from that plane.
//!
//! A person can ask for another joint than this guess. The candidates are the rings around the tip that are narrower
//! than their surroundings, and evenly spaced ones where there is none for a while ([`candidates`]). Fingers are nearer
//! candidates than the guess, which is their hand.
//!
//! If a limb is as thick as it is long, no ring around a point on its side closes before it reaches the body. Rings
//! around a point on a head's side close, but around the face. In both cases the tip is the point farthest from the other
//! end of the surface whose way from there goes through the point ([`FarTips`]). If a point is the tip of a short limb (an
//! ear on a head), the rings around the point show it at once ([`candidates::is_tip`]).
//!
//! A point on a shoulder may be beyond the askew ring of its own joint; then the straight ring decides
//! ([`candidates::just_before`]). The head of a bust is larger than its body; then the neck between the surface's two ends
//! is the joint ([`candidates::neck`]).
//!
//! If the joint is that of a large part, or there is none, the search is made again by ways that count as longer across
//! concave creases ([`ways`]): so an ear, a head without a neck and a tail like a half ball are found. The joints of the
//! search that was not preferred are farther candidates than those of the other.

mod candidates;
mod cut;
mod hunt;
mod level_set;
mod limb;
mod origin;
mod rings;
mod shape;
mod ways;

use glam::DVec3;

use self::candidates::SMALLEST_SHARE;
use self::cut::Cut;
use self::hunt::Hunt;
pub use self::level_set::crossing as level_crossing;
pub use self::limb::{JOINT_RINGS, Joint};
pub use self::shape::Shape;
use self::ways::Ways;
use crate::geodesics::DistanceSearch;
use crate::{Cancel, Cancelled};

/// A limb with this share of the area or more, or none at all, may be wrong: rings across creases are asked, too.
const LARGE_SHARE: f64 = 0.08;

/// Their ring is at most so many times as wide as the plain one.
const NARROWER: f64 = 0.8;

/// Their ring's area over that of its limb is at most so many times as large.
const LESS_NARROW: f64 = 2.0;

/// A limb by the other ways is another one if its area is at least so many times as large.
const FARTHER: f64 = 1.15;

/// The joint between a point in a triangle and the body, which has two fifths of the component's area or more, or less
/// if the limb is the head of a bust; `None` if no ring around the point's side is clearly shorter than that of a disc, as
/// on a ball or a sheet.
///
/// `up` chooses the joint that is so many candidates farther from the limb's tip than the guess, or nearer to it if it is
/// negative. The guess is the first one beyond the point whose limb is more than a finger. If there are fewer, the last one
/// on that side is taken, and [`Joint::up`] has its number.
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
    let plain = || Hunt::new(shape, Ways::plain(), triangle, point, cancel);
    let creased = || {
        let ways = Ways::across_creases(shape, shape.triangles[triangle as usize][0]);
        Hunt::new(shape, ways, triangle, point, cancel)
    };
    let mut hunt = plain();
    let mut guess = hunt.cut(0)?;
    let is_small = |(cut, _): &(Cut, i32)| cut.share < LARGE_SHARE;
    let mut other = None;
    if !guess.as_ref().is_some_and(is_small) {
        let mut across = creased();
        let preferred = across.cut(0)?;
        if is_preferred(preferred.as_ref(), guess.as_ref()) {
            (guess, hunt, across) = (preferred, across, hunt);
        }
        other = Some(across);
    }
    let mut found = if up == 0 { guess } else { hunt.cut(up)? };
    if let Some((last, place)) = found.as_mut().filter(|(_, place)| *place < up) {
        let mut other = other.unwrap_or_else(creased);
        while *place < up
            && let Some(farther) = farther(&mut other, last.share)?
        {
            (*last, *place) = (farther, *place + 1);
        }
    }
    let Some((cut, up)) = found else { return Ok(None) };
    let joint = cut.joint(&mut DistanceSearch::default(), shape);
    Ok(joint.map(|joint| Joint { up, ..joint }))
}

/// The first candidate whose limb is clearly larger than one with this share of the area. By other ways it is a farther
/// one: a neck that is as wide as its head shows in its creases alone.
fn farther(hunt: &mut Hunt<'_>, share: f64) -> Result<Option<Cut>, Cancelled> {
    for up in 0.. {
        let Some((cut, _)) = hunt.cut(up)?.filter(|(_, place)| *place == up) else {
            break;
        };
        if cut.share >= FARTHER * share {
            return Ok(Some(cut));
        }
    }
    Ok(None)
}

/// Returns true if a joint by ways that are longer across creases is better than the plain one: its limb is not a detail,
/// its ring is clearly narrower, and not only because it cuts off less.
fn is_preferred(creased: Option<&(Cut, i32)>, plain: Option<&(Cut, i32)>) -> bool {
    let Some((creased, _)) = creased.filter(|(cut, _)| cut.share >= SMALLEST_SHARE) else {
        return false;
    };
    plain.is_none_or(|(plain, _)| {
        let narrowness = |cut: &Cut| cut.radius * cut.radius / cut.share;
        creased.radius <= NARROWER * plain.radius && narrowness(creased) <= LESS_NARROW * narrowness(plain)
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests;
