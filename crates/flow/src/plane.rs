//! Rotations of the plane as unit vectors, multiplied like complex numbers.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec2;

/// `vector` turned by `rotation`, which has the cosine and the sine of an angle.
#[inline(always)]
pub(crate) fn turned(rotation: DVec2, vector: DVec2) -> DVec2 {
    rotation.rotate(vector)
}

/// `vector` turned by the inverse of `rotation`.
#[inline(always)]
pub(crate) fn turned_back(rotation: DVec2, vector: DVec2) -> DVec2 {
    conjugate(rotation).rotate(vector)
}

/// The inverse rotation.
#[inline(always)]
pub(crate) fn conjugate(rotation: DVec2) -> DVec2 {
    DVec2::new(rotation.x, -rotation.y)
}

/// The rotation from the direction of `from` to that of `to`, neither of which is zero.
#[inline(always)]
pub(crate) fn rotation_between(from: DVec2, to: DVec2) -> DVec2 {
    turned_back(from, to).normalize()
}

/// The largest angle for which [`rotation_by_series`] is right.
pub(crate) const SMALL: f64 = 0.02;

/// The rotation by a small angle, at most [`SMALL`].
#[inline(always)]
pub(crate) fn rotation_by_series(angle: f64) -> DVec2 {
    // The next terms are below 1e-16.
    let square = angle * angle;
    DVec2::new(
        1.0 - square * (0.5 - square * (1.0 / 24.0 - square / 720.0)),
        angle * (1.0 - square * (1.0 / 6.0 - square / 120.0)),
    )
}

/// The rotation by an angle, which mostly is small.
#[inline(always)]
pub(crate) fn small_rotation(angle: f64) -> DVec2 {
    match angle.abs() > SMALL {
        true => DVec2::from_angle(angle),
        false => rotation_by_series(angle),
    }
}

/// The angle from the x axis to a direction that is not zero, counterclockwise, from 0 to a full turn, to 1e-13.
///
/// It is twice that whose tangent is y / (x + length), taken from the nearest axis so that the tangent is at most that
/// of an eighth of a half turn; there nine terms, fitted at Chebyshev's points, are enough. This takes a fifth of the
/// instructions of the library's `atan2`, which is for any tangent.
#[inline(always)]
pub(crate) fn angle(direction: DVec2) -> f64 {
    const TERMS: [f64; 9] = [
        0.030_662_440_370_424_45,
        -0.058_745_056_213_078_31,
        0.075_637_035_519_151_92,
        -0.090_783_920_729_434_23,
        0.111_103_850_461_480_14,
        -0.142_856_904_238_392_87,
        0.199_999_996_048_919_78,
        -0.333_333_333_308_034_46,
        0.999_999_999_999_973_2,
    ];
    let DVec2 { x, y } = direction.abs();
    let (near, far) = if x > y { (x, y) } else { (y, x) };
    let tangent = far / (near + direction.length());
    let square = tangent * tangent;
    let from_axis = 2.0 * tangent * TERMS.iter().fold(0.0, |sum, term| sum * square + term);
    let in_quadrant = if x > y { from_axis } else { FRAC_PI_2 - from_axis };
    let in_half = if direction.x < 0.0 {
        PI - in_quadrant
    } else {
        in_quadrant
    };
    if direction.y < 0.0 { TAU - in_half } else { in_half }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_angle_is_that_of_the_library() {
        for step in 0..100_000 {
            let wanted = f64::from(step) * TAU / 100_000.0;
            for length in [1e-9, 0.3, 4e7] {
                let off = (angle(DVec2::from_angle(wanted) * length) - wanted).abs();
                assert!(off.min(TAU - off) < 1e-13, "{wanted}: {off:e}");
            }
        }
    }
}
