//! From pointer rays to movement: along an axis, within a plane, about an axis.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec2, DVec3};

use crate::view::Ray;

/// The constraint of a transform.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Constraint {
    /// None: the plane of the screen, the axis of sight, all axes at once.
    #[default]
    Free,
    /// Along or about one axis: 0, 1, 2 for x, y, z.
    Axis(usize),
    /// Every axis except this one.
    Plane(usize),
}

impl Constraint {
    /// Its form in the status line: "x", "y and z".
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::Free | Self::Axis(3..) | Self::Plane(3..) => "",
            Self::Axis(0) => " along x",
            Self::Axis(1) => " along y",
            Self::Axis(2) => " along z",
            Self::Plane(0) => " in y and z",
            Self::Plane(1) => " in x and z",
            Self::Plane(2) => " in x and y",
        }
    }
}

/// The point of the ray's closest approach on the line through `origin` along the unit vector `axis`, as a length from
/// `origin`.
///
/// `None` if the ray is nearly parallel to the line, so that a small movement would become a huge one.
pub(crate) fn along_axis(ray: Ray, origin: DVec3, axis: DVec3) -> Option<f64> {
    let cosine = ray.direction.dot(axis);
    let sine_squared = 1.0 - cosine * cosine;
    if sine_squared < 1e-4 {
        return None;
    }
    let between = origin - ray.origin;
    Some((cosine * ray.direction.dot(between) - axis.dot(between)) / sine_squared)
}

/// The intersection of the ray with the plane through `origin` with the unit normal `normal`; `None` if it is nearly
/// parallel to the plane or leads away from it.
pub(crate) fn on_plane(ray: Ray, origin: DVec3, normal: DVec3) -> Option<DVec3> {
    let slope = ray.direction.dot(normal);
    if slope.abs() < 1e-3 {
        return None;
    }
    let distance = (origin - ray.origin).dot(normal) / slope;
    (distance > 0.0).then(|| ray.origin + ray.direction * distance)
}

/// The angle of a point of the screen about a centre, counterclockwise for the viewer; `None` at the centre.
pub(crate) fn screen_angle_rad(position_px: DVec2, centre_px: DVec2) -> Option<f64> {
    let arm = position_px - centre_px;
    (arm.length_squared() > 1.0).then(|| (-arm.y).atan2(arm.x))
}

/// The angle of a point about an axis, right-handed, from an arbitrary but fixed zero.
pub(crate) fn angle_about_axis_rad(point: DVec3, origin: DVec3, axis: DVec3) -> Option<f64> {
    let arm = point - origin;
    let first = axis.any_orthonormal_vector();
    let second = axis.cross(first);
    let (x, y) = (arm.dot(first), arm.dot(second));
    (x != 0.0 || y != 0.0).then(|| y.atan2(x))
}

/// The turn from one angle to the next by the short way, −π to π, so that turns add up past half a circle.
pub(crate) fn short_turn_rad(from: f64, to: f64) -> f64 {
    (to - from + PI).rem_euclid(TAU) - PI
}

/// The rotation by an angle about a unit axis; the exact identity for 0.
pub(crate) fn rotation(axis: DVec3, angle_rad: f64) -> DQuat {
    if angle_rad == 0.0 {
        DQuat::IDENTITY
    } else {
        DQuat::from_axis_angle(axis, angle_rad)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use std::f64::consts::PI;

    use glam::DVec3;

    use super::{along_axis, angle_about_axis_rad, on_plane, short_turn_rad};
    use crate::view::Ray;

    #[test]
    fn a_ray_at_a_point_of_the_axis_gives_that_point() {
        let origin = DVec3::new(1.0, 2.0, 3.0);
        for axis in [DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 1.0).normalize()] {
            for length in [-2.0, 0.0, 0.7] {
                let eye = DVec3::new(5.0, -4.0, 9.0);
                let ray = Ray {
                    origin: eye,
                    direction: (origin + axis * length - eye).normalize(),
                };
                assert!((along_axis(ray, origin, axis).unwrap() - length).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn rays_along_the_axis_or_the_plane_say_nothing() {
        let ray = Ray {
            origin: DVec3::ZERO,
            direction: DVec3::X,
        };
        assert_eq!(along_axis(ray, DVec3::Y, DVec3::X), None);
        assert_eq!(on_plane(ray, DVec3::Y, DVec3::Y), None);
        assert_eq!(on_plane(ray, DVec3::NEG_X, DVec3::X), None);
    }

    #[test]
    fn a_quarter_turn_is_a_quarter_turn_about_any_axis() {
        for axis in [DVec3::X, DVec3::Z, DVec3::new(-0.3, 0.5, 0.2).normalize()] {
            let arm = axis.any_orthonormal_vector() * 3.0 + axis;
            let turned = axis.cross(arm) + axis;
            let angles = [arm, turned].map(|point| angle_about_axis_rad(point, DVec3::ZERO, axis).unwrap());
            assert!((short_turn_rad(angles[0], angles[1]) - 0.5 * PI).abs() < 1e-12);
        }
    }
}
