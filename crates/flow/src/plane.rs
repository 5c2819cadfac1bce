//! Rotations of the plane as unit vectors, multiplied like complex numbers.

use glam::DVec2;

/// `vector` turned by `rotation`, which has the cosine and the sine of an angle.
#[inline]
pub(crate) fn turned(rotation: DVec2, vector: DVec2) -> DVec2 {
    rotation.rotate(vector)
}

/// `vector` turned by the inverse of `rotation`.
#[inline]
pub(crate) fn turned_back(rotation: DVec2, vector: DVec2) -> DVec2 {
    conjugate(rotation).rotate(vector)
}

/// The inverse rotation.
#[inline]
pub(crate) fn conjugate(rotation: DVec2) -> DVec2 {
    DVec2::new(rotation.x, -rotation.y)
}

/// The rotation from the direction of `from` to that of `to`, neither of which is zero.
#[inline]
pub(crate) fn rotation_between(from: DVec2, to: DVec2) -> DVec2 {
    turned_back(from, to).normalize()
}
