//! The grid on the ground: where it lies and how far its lines are apart.

use glam::{DVec2, DVec3};
use pliant_editor::{Camera, Projection, UpAxis};
use pliant_render::Grid;

/// About how many points of the screen lie between two lines.
const SPACING_PX: f64 = 26.0;
/// The grid reaches this many of its steps, or the eye's distance times the second, whichever is more.
const REACH_STEPS: f64 = 40.0;
const REACH_DISTANCES: f64 = 4.0;

/// How much of the lines' alpha is left from below, where they lie before the model.
const SHARE_FROM_BELOW: f32 = 0.4;

const LINES: [u8; 4] = [168, 176, 190, 48];
/// Muted x, y and z, in the gizmo's order.
const AXES: [[u8; 4]; 3] = [[190, 84, 90, 190], [112, 158, 72, 190], [84, 126, 196, 190]];

/// The grid at the height `ground` along the up axis, under what the camera looks at, relative to `centre`. Lines are a
/// power of ten apart, in world units, so that it measures.
pub fn ground(camera: &Camera, viewport_px: DVec2, ground: f64, centre: DVec3) -> Grid {
    let (up, [u, v]) = match camera.up {
        UpAxis::Y => (1, [2, 0]),
        UpAxis::Z => (2, [0, 1]),
    };
    let wanted = SPACING_PX * camera.world_per_px(camera.target, viewport_px);
    let power = wanted.max(f64::MIN_POSITIVE).log10();
    let step = 10.0_f64.powf(power.floor());
    // The finer lines fade while the step waits to become ten times as wide.
    let fine_share = 1.0 - (power - power.floor());
    // A crossing of strong lines: the texture of lines stays where it is in the world as the camera moves.
    let strong = 10.0 * step;
    let mut middle = DVec3::ZERO;
    for axis in [u, v] {
        middle[axis] = (camera.target[axis] / strong).round() * strong;
    }
    middle[up] = ground;
    let span = match camera.projection {
        Projection::Perspective => REACH_DISTANCES * camera.distance,
        Projection::Orthographic => 2.0 * camera.distance,
    };
    let along = |axis: usize| {
        let mut direction = [0.0; 3];
        direction[axis] = 1.0;
        direction
    };
    let share = match camera.projection {
        Projection::Perspective if camera.eye()[up] < ground => SHARE_FROM_BELOW,
        Projection::Orthographic if camera.forward()[up] > 0.0 => SHARE_FROM_BELOW,
        Projection::Perspective | Projection::Orthographic => 1.0,
    };
    let fainter = |[r, g, b, a]: [u8; 4]| [r, g, b, (f32::from(a) * share) as u8];
    Grid {
        middle: (middle - centre).as_vec3().to_array(),
        along: [along(u), along(v)],
        step: step as f32,
        reach: span.max(REACH_STEPS * step) as f32,
        fine_share: fine_share as f32,
        axes: [u, v].map(|axis| (-middle[axis] / step) as f32),
        colour: fainter(LINES),
        axis_colours: [u, v].map(|axis| fainter(AXES[axis])),
    }
}
