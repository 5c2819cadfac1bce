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

/// The rotation by an angle, which mostly is small.
#[inline]
pub(crate) fn small_rotation(angle: f64) -> DVec2 {
    if angle.abs() > 0.02 {
        return DVec2::from_angle(angle);
    }
    // The next terms are below 1e-16.
    let square = angle * angle;
    DVec2::new(
        1.0 - square * (0.5 - square * (1.0 / 24.0 - square / 720.0)),
        angle * (1.0 - square * (1.0 / 6.0 - square / 120.0)),
    )
}
