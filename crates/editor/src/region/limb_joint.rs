//! The joint of a limb on a body with loose parts: eyes, teeth and shells that touch it count as the body's own.

use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::{Cancel, Cancelled, Joint, Model, Shape, SurfaceVertex, face_area, joint_of};

use super::loose::FileContacts;

/// A chain ends before the joint whose limb has more than this share of the area: that is the body.
const CHAIN_SHARE: f64 = 0.25;

/// A chain has at most so many joints.
const CHAIN_JOINTS: i32 = 5;

/// The limb at a point of the surface.
#[derive(Clone, Debug)]
pub struct FoundLimb {
    /// The joint at which it leaves the body, or another limb.
    pub joint: Arc<Joint>,
    /// The joints between there and its tip if a chain was asked for, in this order.
    pub inner: Vec<Arc<Joint>>,
}

/// The limb at a point in a triangle with all its joints, from the last one before the body on; from the candidate `up`
/// on if that is above 0.
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
    let most = CHAIN_SHARE * area(shape, |_| true);
    let mut joints = Vec::new();
    let last = if up > 0 { up } else { CHAIN_JOINTS - 1 };
    for place in 0..=last {
        let Some(joint) = limb_joint(model, shape, contacts, at, place, cancel)? else {
            break;
        };
        let on_limb = |v: SurfaceVertex| joint.limb.binary_search(&v).is_ok();
        let is_body = up <= 0 && place > 0 && area(shape, on_limb) > most;
        if joint.up != place || is_body {
            break;
        }
        joints.push(Arc::new(joint));
    }
    let Some(joint) = joints.pop() else { return Ok(None) };
    joints.reverse();
    Ok(Some(FoundLimb { joint, inner: joints }))
}

/// The area of the triangles whose first corner is one of these vertices.
fn area(shape: &Shape<'_>, counts: impl Fn(SurfaceVertex) -> bool) -> f64 {
    let own = shape.triangles.iter().filter(|triangle| counts(triangle[0]));
    own.map(|triangle| face_area(triangle.map(|v| shape.positions[v.index()])))
        .sum()
}

/// The joint of the limb at a point in a triangle. A part that touches a much larger one has no joint of its own: the
/// limb is the larger one's at that place. Parts that touch the limb belong to it. `up` and the result are those of
/// [`joint_of`].
///
/// # Errors
/// [`Cancelled`] soon after `cancel` is raised.
pub(crate) fn limb_joint(
    model: &Model,
    shape: &Shape<'_>,
    contacts: &FileContacts,
    (triangle, point): (u32, DVec3),
    up: i32,
    cancel: &Cancel,
) -> Result<Option<Joint>, Cancelled> {
    let topology = &model.topology;
    if topology.components().len() == 1 {
        return joint_of(shape, triangle, point, up, cancel);
    }
    let touching = contacts.of(model, cancel)?;
    let corner = shape.triangles[triangle as usize][0];
    let carrier = touching.carrier(topology, shape.positions, corner, point);
    let (triangle, point) = match carrier {
        None => (triangle, point),
        Some(place) => {
            let mut faces = topology.faces(place, shape.triangles);
            // A bare point has no triangle.
            let Some(face) = faces.next() else { return Ok(None) };
            (face, shape.positions[place.index()])
        }
    };
    let found = joint_of(shape, triangle, point, up, cancel)?;
    let body = topology.component(shape.triangles[triangle as usize][0]);
    Ok(found.map(|mut joint| {
        for vertices in [&mut joint.limb, &mut joint.far_side] {
            let mut riders = touching.riders(topology, body, vertices);
            riders.extend(carrier.map(|_| topology.component(corner)));
            vertices.extend(riders.into_iter().flat_map(|part| topology.vertices_of(part)));
            vertices.sort_unstable();
            vertices.dedup();
        }
        joint
    }))
}
