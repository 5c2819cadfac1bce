//! The display of a joint: rings around the limb that fade with the falloff, and a dot at the centre of the turn.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use pliant_mesh::{JOINT_RINGS, Joint};

use crate::view::{Camera, ControlShape};

const COLOUR: [u8; 3] = [255, 150, 30];
const RIM: [u8; 4] = [18, 24, 36, 255];
const DOT_PX: f64 = 5.0;
const RIM_PX: f64 = 1.5;
const DOT_SEGMENTS: usize = 20;

/// The shapes of a joint, or of the pivot alone if the limb was posed before.
pub(crate) fn joint_shapes(
    centre: DVec3,
    joint: Option<&Joint>,
    camera: &Camera,
    viewport_px: DVec2,
) -> Vec<ControlShape> {
    let px = camera.world_per_px(centre, viewport_px);
    // They are moved towards the eye, so that the surface does not hide them.
    let lifted = |point: DVec3| point + camera.towards_eye(point) * px;
    let mut shapes = Vec::new();
    let middle = JOINT_RINGS / 2;
    for (number, ring) in joint.iter().flat_map(|joint| joint.rings.iter().enumerate()) {
        let share = number.abs_diff(middle) as f64 / (middle + 1) as f64;
        let [red, green, blue] = COLOUR;
        shapes.push(ControlShape {
            colour: [red, green, blue, (255.0 * (1.0 - share)) as u8],
            lines: ring.iter().map(|ends| ends.map(lifted)).collect(),
            triangles: Vec::new(),
        });
    }
    let [red, green, blue] = COLOUR;
    for (radius_px, colour) in [(DOT_PX + RIM_PX, RIM), (DOT_PX, [red, green, blue, 255])] {
        shapes.push(ControlShape {
            colour,
            lines: Vec::new(),
            triangles: disc(centre, radius_px * px, camera),
        });
    }
    shapes
}

/// A disc across the line of sight.
fn disc(centre: DVec3, radius: f64, camera: &Camera) -> Vec<[DVec3; 3]> {
    let axes = camera.axes();
    let rim = |step: usize| {
        let direction = DVec2::from_angle(TAU * step as f64 / DOT_SEGMENTS as f64) * radius;
        centre + axes.x_axis * direction.x + axes.y_axis * direction.y
    };
    (0..DOT_SEGMENTS)
        .map(|step| [centre, rim(step), rim(step + 1)])
        .collect()
}
