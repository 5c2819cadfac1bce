//! An arc that shows a turn: a fan between the old and the new direction.

use glam::{DQuat, DVec2, DVec3};

use super::camera::Camera;
use super::control_shapes::ControlShape;

const FAN: [u8; 4] = [255, 190, 80, 70];
const LINE: [u8; 4] = [255, 190, 80, 255];
/// The arc's radius in points of the view.
const RADIUS_PX: f64 = 56.0;
/// The angle between two corners of an arc, in degrees.
const STEP_DEG: f64 = 4.0;

/// The arc of a turn by an angle in radians about a unit axis, from the direction `from` seen from the centre. Full turns
/// are left out.
pub(crate) fn arc_shapes(
    centre: DVec3,
    axis: DVec3,
    from: DVec3,
    angle_rad: f64,
    camera: &Camera,
    viewport_px: DVec2,
) -> [ControlShape; 2] {
    let radius = RADIUS_PX * camera.world_per_px(centre, viewport_px);
    let start = from.reject_from(axis).try_normalize();
    let start = start.unwrap_or_else(|| axis.any_orthonormal_vector()) * radius;
    let angle_rad = angle_rad % std::f64::consts::TAU;
    let steps = (angle_rad.to_degrees().abs() / STEP_DEG).ceil().max(1.0);
    let rim = |step: u32| centre + DQuat::from_axis_angle(axis, angle_rad * f64::from(step) / steps) * start;
    let steps = steps as u32;
    let mut lines: Vec<[DVec3; 2]> = (0..steps).map(|step| [rim(step), rim(step + 1)]).collect();
    lines.extend([[centre, rim(0)], [centre, rim(steps)]]);
    let fan = (0..steps).map(|step| [centre, rim(step), rim(step + 1)]);
    [
        ControlShape::filled(FAN, fan.collect()),
        ControlShape::lines(LINE, lines),
    ]
}
