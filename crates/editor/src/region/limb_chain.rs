//! All joints of a limb, from the body to its tip.
//!
//! The chain is walked from joint to joint: a point a little beyond one joint leads to the next. The rings around a
//! fingertip show knuckles and a wrist, but hardly an elbow; the rings around the hand, seen from the forearm, do.

use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::{Cancel, Cancelled, Joint, Model, Shape, SurfaceVertex, face_area};

use super::limb_joint::limb_joint;
use super::loose::FileContacts;

/// A chain ends before the joint whose limb has more than this share of the area: that is the body.
const BODY_SHARE: f64 = 0.25;

/// A chain has at most so many joints.
const MOST_JOINTS: usize = 5;

/// A joint whose limb has less than this share of the whole limb's area is a knuckle, and not one of the chain.
const KNUCKLE_SHARE: f64 = 0.15;

/// A bone is at least so many radii long, by the thicker of its joints: two rings through a wrist, or a hip and the ring
/// around the pelvis, are one joint.
const BONE_RADII: f64 = 1.5;

/// A limb has so many times the area of the part beyond its next joint.
const GROWS: f64 = 1.15;

/// The next ring is among so many candidates beyond the one before it.
const CANDIDATES: i32 = 4;

/// The walk passes at most so many rings.
const MOST_STEPS: usize = 12;

/// The limb at a point of the surface.
#[derive(Clone, Debug)]
pub struct FoundLimb {
    /// The joint at which it leaves the body, or another limb.
    pub joint: Arc<Joint>,
    /// The joints between there and its tip if a chain was asked for, in this order.
    pub inner: Vec<Arc<Joint>>,
}

/// The limb at a point in a triangle with all its joints, from the last one before the body on; with `up` joints beyond
/// the first if that is above 0. The joint's own `up` is the number of joints between it and the tip.
///
/// # Errors
/// [`Cancelled`] soon after `cancel` is raised.
pub(crate) fn limb_chain(
    model: &Model,
    shape: &Shape<'_>,
    contacts: &FileContacts,
    at: (u32, DVec3),
    up: i32,
    cancel: &Cancel,
) -> Result<Option<FoundLimb>, Cancelled> {
    let body = BODY_SHARE * area(shape, |_| true);
    let wanted = usize::try_from(up).ok().filter(|&up| up > 0).map(|up| up + 1);
    let mut chain: Vec<Arc<Link>> = Vec::new();
    let (mut place, mut passed) = (at, None);
    for _ in 0..MOST_STEPS {
        let Some(link) = next(model, shape, contacts, place, passed.as_deref(), cancel)? else {
            break;
        };
        let link = Arc::new(link);
        if wanted.is_none() && !chain.is_empty() && link.area > body {
            break;
        }
        if chain.last().is_none_or(|before| link.makes_a_bone_with(before)) {
            chain.push(Arc::clone(&link));
            chain.retain(|part| part.area >= KNUCKLE_SHARE * link.area);
        }
        if chain.len() == wanted.unwrap_or(MOST_JOINTS) {
            break;
        }
        let Some(beyond) = beyond(shape, &link.joint, at.1) else {
            break;
        };
        (place, passed) = (beyond, Some(link));
    }
    let numbered = chain.iter().enumerate().map(|(up, link)| Joint {
        up: up as i32,
        ..link.joint.clone()
    });
    let mut joints = numbered.rev().map(Arc::new);
    let Some(joint) = joints.next() else { return Ok(None) };
    let inner = joints.collect();
    Ok(Some(FoundLimb { joint, inner }))
}

/// A joint of a chain, with the area of its limb in square world units.
struct Link {
    joint: Joint,
    area: f64,
}

/// The first joint beyond a place whose limb has the limb of the joint `before` as a part; `None` if there is none.
fn next(
    model: &Model,
    shape: &Shape<'_>,
    contacts: &FileContacts,
    place: (u32, DVec3),
    before: Option<&Link>,
    cancel: &Cancel,
) -> Result<Option<Link>, Cancelled> {
    for up in 0..CANDIDATES {
        let found = limb_joint(model, shape, contacts, place, up, cancel)?;
        let Some(joint) = found.filter(|joint| joint.up == up) else {
            break;
        };
        let link = Link::of(joint, shape);
        if before.is_none_or(|before| link.holds(before)) {
            return Ok(Some(link));
        }
    }
    Ok(None)
}

impl Link {
    fn of(joint: Joint, shape: &Shape<'_>) -> Self {
        let area = area(shape, |v| joint.limb.binary_search(&v).is_ok());
        Self { joint, area }
    }

    /// Returns true if the limb of the joint `before` is a part of this one's.
    fn holds(&self, before: &Self) -> bool {
        let has = |v: &SurfaceVertex| self.joint.limb.binary_search(v).is_ok();
        self.area > before.area && before.joint.far_side.iter().all(has)
    }

    fn makes_a_bone_with(&self, before: &Self) -> bool {
        let radius = self.joint.radius.max(before.joint.radius);
        self.joint.centre.distance(before.joint.centre) >= BONE_RADII * radius && self.area >= GROWS * before.area
    }
}

/// A place on the other side of a joint, beyond its falloff, on the side of the limb that `near` is on.
fn beyond(shape: &Shape<'_>, joint: &Joint, near: DVec3) -> Option<(u32, DVec3)> {
    let ring = joint.rings.iter().rfind(|ring| !ring.is_empty())?;
    let distance = |point: DVec3| point.distance_squared(near);
    let on_ring = ring.iter().map(|segment| segment[0]);
    let point = on_ring.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))?;
    shape.nearest(point)
}

/// The area of the triangles whose first corner is one of these vertices, in square world units.
fn area(shape: &Shape<'_>, counts: impl Fn(SurfaceVertex) -> bool) -> f64 {
    let own = shape.triangles.iter().filter(|triangle| counts(triangle[0]));
    own.map(|triangle| face_area(triangle.map(|v| shape.positions[v.index()])))
        .sum()
}
