//! The motion of a mirrored handle.

use glam::{DAffine3, DQuat, DVec3};
use pliant_mesh::MirrorPlane;

use super::handle_transform::HandleTransform;

/// The transform of a handle on the other side of a plane if one on this side, with this pivot, has `transform`.
pub(crate) fn mirrored_transform(plane: &MirrorPlane, transform: HandleTransform, pivot: DVec3) -> HandleTransform {
    match transform {
        // Scales along the world's axes stay along them in a mirror across one of them.
        HandleTransform::Trs {
            translation,
            rotation,
            scale,
            pivot,
        } if plane.axis().is_some() || scale == DVec3::splat(scale.x) => {
            // A rotation's axis turns the other way round in a mirror.
            let axis = -plane.mirrored_vector(rotation.xyz());
            let rotation = if rotation.xyz() == DVec3::ZERO {
                rotation
            } else {
                DQuat::from_xyzw(axis.x, axis.y, axis.z, rotation.w)
            };
            HandleTransform::Trs {
                translation: plane.mirrored_vector(translation),
                rotation,
                scale,
                pivot: pivot.map(|pivot| plane.mirrored(pivot)),
            }
        }
        HandleTransform::Trs { .. } | HandleTransform::Matrix(_) => {
            let mirror = DAffine3 {
                matrix3: plane.reflection(),
                translation: plane.mirrored(DVec3::ZERO),
            };
            HandleTransform::Matrix(mirror * transform.affine(pivot) * mirror)
        }
    }
}
