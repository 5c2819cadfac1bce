//! A plane to mirror across, and what a mirrored handle does.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::handle_transform::HandleTransform;

/// A plane across an axis of the world.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct MirrorPlane {
    /// 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// Where it crosses the axis, in world units.
    pub at: f64,
}

impl MirrorPlane {
    /// What a handle on the other side does when one on this side does `transform`.
    pub(crate) fn mirrored_transform(&self, transform: HandleTransform) -> HandleTransform {
        let mut flip = DVec3::ONE;
        flip[self.axis] = -1.0;
        match transform {
            HandleTransform::Trs {
                translation,
                rotation,
                scale,
                pivot,
            } => {
                // A rotation's axis turns the other way round in a mirror.
                let axis = -(rotation.xyz() * flip);
                let rotation = if rotation.xyz() == DVec3::ZERO {
                    rotation
                } else {
                    DQuat::from_xyzw(axis.x, axis.y, axis.z, rotation.w)
                };
                HandleTransform::Trs {
                    translation: translation * flip,
                    rotation,
                    scale,
                    pivot: pivot.map(|pivot| self.mirrored(pivot)),
                }
            }
            HandleTransform::Matrix(matrix) => {
                let mut shift = DVec3::ZERO;
                shift[self.axis] = 2.0 * self.at;
                let mirror = DAffine3 {
                    matrix3: DMat3::from_diagonal(flip),
                    translation: shift,
                };
                HandleTransform::Matrix(mirror * matrix * mirror)
            }
        }
    }

    /// The point on the other side.
    pub fn mirrored(&self, point: DVec3) -> DVec3 {
        let mut other = point;
        other[self.axis] = 2.0 * self.at - point[self.axis];
        other
    }
}
