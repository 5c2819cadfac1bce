//! The joint of a limb on a body with loose parts: eyes, teeth and shells that touch it count as the body's own.

use glam::DVec3;
use pliant_mesh::{Cancel, Cancelled, Joint, Model, Shape, joint_of};

use super::loose::FileContacts;

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
