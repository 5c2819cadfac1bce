//! The frame of a triangle, in which deformation gradients are expressed [SP04, equation 2].

use glam::{DMat3, DVec3};

/// M: two edges and the unit normal; `None` if the triangle has no area.
#[inline]
pub(crate) fn triangle_frame([a, b, c]: [DVec3; 3]) -> Option<DMat3> {
    let (first, second) = (b - a, c - a);
    Some(DMat3::from_cols(first, second, first.cross(second).try_normalize()?))
}
