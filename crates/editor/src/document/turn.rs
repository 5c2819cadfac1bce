//! A handle's turn as three angles that continue to count: 270° stays 270°, and a second full turn is 720°.
//!
//! The rotation itself is a quaternion, which has no full turns. Among all triples of angles about x, y and z for the
//! same rotation, the window shows the one nearest to the last.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3, EulerRot};

/// The longest step of a tracked turn: a third of an ambiguous one.
const STEP_RAD: f64 = std::f64::consts::FRAC_PI_3;

/// Below this sine of half its angle a rotation has no defined axis.
const NO_TURN: f64 = 1e-9;

/// The rotation of angles about x, y and z in degrees.
pub(crate) fn rotation_of(turn_deg: DVec3) -> DQuat {
    let [x, y, z] = turn_deg.map(f64::to_radians).to_array();
    DQuat::from_euler(EulerRot::XYZ, x, y, z)
}

/// Returns true if angles in degrees are a rotation, to the precision of numbers of that size.
pub(crate) fn means(turn_deg: DVec3, rotation: DQuat) -> bool {
    turn_deg.is_finite() && rotation_of(turn_deg).dot(rotation).abs() > 1.0 - 1e-9
}

/// The angles in degrees of `rotation` that are nearest to `before_deg`.
pub(crate) fn followed(before_deg: DVec3, rotation: DQuat) -> DVec3 {
    if rotation.xyz() == DVec3::ZERO {
        return nearest_of(before_deg, DVec3::ZERO);
    }
    let (x, y, z) = rotation.to_euler(EulerRot::XYZ);
    let plain = DVec3::new(x, y, z).map(f64::to_degrees);
    let other = DVec3::new(plain.x + 180.0, 180.0 - plain.y, plain.z + 180.0);
    let [plain, other] = [plain, other].map(|angles| nearest_of(before_deg, angles));
    if plain.distance(before_deg) <= other.distance(before_deg) {
        plain
    } else {
        other
    }
}

/// Each angle with the full turns that bring it nearest to another.
fn nearest_of(to_deg: DVec3, angles_deg: DVec3) -> DVec3 {
    // Adding 0 makes −0 a plain 0.
    angles_deg + ((to_deg - angles_deg) / 360.0).round() * 360.0 + 0.0
}

/// The angles after a turn by any angle about an axis, from the start `start_deg`.
pub(crate) fn accumulated(start_deg: DVec3, start: DQuat, axis: DVec3, angle_rad: f64) -> DVec3 {
    let steps = (angle_rad.abs() / STEP_RAD).ceil().clamp(1.0, 1e4);
    (1..=steps as u32).fold(start_deg, |shown, step| {
        let turn = DQuat::from_axis_angle(axis, angle_rad * f64::from(step) / steps);
        followed(shown, turn * start)
    })
}

/// The share `t` of a rotation with the counted turn `turn_deg`: about its own axis, the short way round unless the
/// count is more than half a turn about x, y or z.
pub(crate) fn part_of(rotation: DQuat, turn_deg: DVec3, t: f64) -> DQuat {
    let short = if rotation.w < 0.0 { -rotation } else { rotation };
    let turns = full_turns(short, turn_deg);
    if turns == 0.0 {
        return DQuat::IDENTITY.slerp(rotation, t).normalize();
    }
    let (axis, angle) = axis_and_angle(short, turn_deg);
    DQuat::from_axis_angle(axis, t * (angle + turns * TAU))
}

/// Returns true if a rotation is counted the short way round.
pub(crate) fn is_short(rotation: DQuat, turn_deg: DVec3) -> bool {
    full_turns(if rotation.w < 0.0 { -rotation } else { rotation }, turn_deg) == 0.0
}

/// The number of counted full turns beyond the short way of a rotation with w ≥ 0.
fn full_turns(short: DQuat, turn_deg: DVec3) -> f64 {
    if turn_deg.abs().max_element() <= 180.0 {
        return 0.0;
    }
    let (axis, angle) = axis_and_angle(short, turn_deg);
    ((turn_deg.map(f64::to_radians).dot(axis) - angle) / TAU).round()
}

/// The axis and the angle in radians of a rotation with w ≥ 0. If there are only full turns, the axis is that of the
/// count.
fn axis_and_angle(short: DQuat, turn_deg: DVec3) -> (DVec3, f64) {
    let (sine, axis) = (short.xyz().length(), short.xyz());
    if sine < NO_TURN {
        (turn_deg.normalize_or(DVec3::X), 0.0)
    } else {
        (axis / sine, 2.0 * sine.atan2(short.w))
    }
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};

    use super::{accumulated, followed, part_of, rotation_of};

    #[test]
    fn a_share_of_a_turn_is_that_share_of_what_is_counted() {
        for unit in [DVec3::X, DVec3::Y, DVec3::Z] {
            for degrees in [40.0, 170.0, 270.0_f64, -200.0, 360.0, 725.0, -1000.0] {
                let whole = rotation_of(unit * degrees);
                for t in [0.1, 0.5, 0.9] {
                    let wanted = DQuat::from_axis_angle(unit, t * degrees.to_radians());
                    let part = part_of(whole, unit * degrees, t);
                    assert!(part.dot(wanted).abs() > 1.0 - 1e-9, "{t} of {degrees} about {unit}");
                }
                assert!(part_of(whole, unit * degrees, 1.0).dot(whole).abs() > 1.0 - 1e-9);
            }
        }
    }

    #[test]
    fn a_turn_about_an_axis_counts_on_beyond_half_and_full_turns() {
        for (axis, unit) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
            for degrees in [30.0, 170.0, 270.0_f64, -200.0, 360.0, 725.0] {
                let shown = accumulated(DVec3::ZERO, DQuat::IDENTITY, unit, degrees.to_radians());
                let rotation = DQuat::from_axis_angle(unit, degrees.to_radians());
                assert!(rotation_of(shown).dot(rotation).abs() > 1.0 - 1e-9, "{shown}");
                // About y two triples meet at a right angle; about the others only one angle counts.
                if axis != 1 || degrees.abs() < 90.0 {
                    assert!(
                        (shown[axis] - degrees).abs() < 1e-6,
                        "{shown} for {degrees} about {unit}"
                    );
                }
            }
        }
    }

    #[test]
    fn whatever_is_shown_means_the_rotation() {
        for seed in 0..200 {
            let part = |k: u32| f64::from((seed * 7919 + k * 104_729) % 1000) / 500.0 - 1.0;
            let rotation = DQuat::from_xyzw(part(1), part(2), part(3), part(4) + 1e-3).normalize();
            let before = DVec3::new(part(5), part(6), part(7)) * 900.0;
            let shown = followed(before, rotation);
            assert!(rotation_of(shown).dot(rotation).abs() > 1.0 - 1e-9);
            assert!((shown - before).abs().max_element() <= 360.0);
        }
    }
}
