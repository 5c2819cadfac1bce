//! The display of a joint: rings around the limb that fade with the falloff, the bone from the centre of the turn to the
//! next joint or the limb's tip, and a dot at the centre.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use pliant_mesh::{JOINT_RINGS, Joint};

use crate::view::{Camera, ControlShape};

const COLOUR: [u8; 3] = [255, 150, 30];
const RIM: [u8; 4] = [18, 24, 36, 255];
const DOT_PX: f64 = 5.0;
const RIM_PX: f64 = 1.5;
const DOT_SEGMENTS: usize = 20;
/// The opacity of the bone's filling, of 255.
const BONE: u8 = 110;
/// The place of the bone's widest part, and half of its width there, in its lengths.
const BONE_WAIST: f64 = 0.14;
const BONE_HALF_WIDTH: f64 = 0.045;
/// The lines of a ring behind the limb are a trace, so that the ring is read as one.
const RING_HIDDEN_SHARE: f32 = 0.12;
/// The bone and the dot are inside the limb and yet visible.
const BONE_HIDDEN_SHARE: f32 = 0.7;

/// The shapes of a joint and of the bone from there to a point, or of the pivot alone if the limb was posed before.
pub(crate) fn joint_shapes(
    centre: DVec3,
    joint: Option<(&Joint, DVec3)>,
    camera: &Camera,
    viewport_px: DVec2,
) -> Vec<ControlShape> {
    let px = camera.world_per_px(centre, viewport_px);
    // They are moved towards the eye, so that the surface does not hide them.
    let lifted = |point: DVec3| point + camera.towards_eye(point) * px;
    let mut shapes = Vec::new();
    let middle = JOINT_RINGS / 2;
    let [red, green, blue] = COLOUR;
    for (number, ring) in joint.iter().flat_map(|(joint, _)| joint.rings.iter().enumerate()) {
        let share = number.abs_diff(middle) as f64 / (middle + 1) as f64;
        let colour = [red, green, blue, (255.0 * (1.0 - share)) as u8];
        let lines = ring.iter().map(|ends| ends.map(lifted)).collect();
        shapes.push(ControlShape::lines(colour, lines).with_hidden_share(RING_HIDDEN_SHARE));
    }
    if let Some((joint, end)) = joint {
        shapes.extend(bone(joint.centre, end, camera));
    }
    for (radius_px, colour) in [(DOT_PX + RIM_PX, RIM), (DOT_PX, [red, green, blue, 255])] {
        let dot = ControlShape::filled(colour, disc(centre, radius_px * px, camera));
        shapes.push(dot.with_hidden_share(BONE_HIDDEN_SHARE));
    }
    shapes
}

/// A kite across the line of sight from a joint to the next one or to the limb's tip: its filling and its outline.
fn bone(from: DVec3, to: DVec3, camera: &Camera) -> [ControlShape; 2] {
    let waist = from.lerp(to, BONE_WAIST);
    let aside = (to - from).cross(camera.towards_eye(waist)) * BONE_HALF_WIDTH;
    let corners = [from, waist + aside, to, waist - aside];
    let [red, green, blue] = COLOUR;
    let filling = [
        [corners[0], corners[1], corners[3]],
        [corners[1], corners[2], corners[3]],
    ];
    let outline = (0..4).map(|corner| [corners[corner], corners[(corner + 1) % 4]]);
    [
        ControlShape::filled([red, green, blue, BONE], filling.to_vec()),
        ControlShape::lines([red, green, blue, 255], outline.collect()),
    ]
    .map(|shape| shape.with_hidden_share(BONE_HIDDEN_SHARE))
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
