//! The ground grid: its position and spacing.

use glam::{DVec2, DVec3};
use pliant_editor::{Camera, Projection, UpAxis};
use pliant_render::Grid;

/// Approximate distance between lines on the screen, in points.
const SPACING_PX: f64 = 26.0;
/// The grid's radius: this many steps, or this many camera distances, whichever is larger.
const REACH_STEPS: f64 = 40.0;
const REACH_DISTANCES: f64 = 4.0;

/// Factor of alpha when the grid is seen from below, where it is in front of the model.
const SHARE_FROM_BELOW: f32 = 0.4;

const LINES: [u8; 4] = [168, 176, 190, 48];
/// Muted colours of the x, y and z axes.
const AXES: [[u8; 4]; 3] = [[190, 84, 90, 190], [112, 158, 72, 190], [84, 126, 196, 190]];

/// The grid at height `ground` along the up axis, below the camera's target, relative to `centre`. Its step is a power
/// of ten in world units, so that it can be used for measuring.
pub fn ground(camera: &Camera, viewport_px: DVec2, ground: f64, centre: DVec3) -> Grid {
    let (up, [u, v]) = match camera.up {
        UpAxis::Y => (1, [2, 0]),
        UpAxis::Z => (2, [0, 1]),
    };
    let wanted = SPACING_PX * camera.world_per_px(camera.target, viewport_px);
    let power = wanted.max(f64::MIN_POSITIVE).log10();
    let step = 10.0_f64.powf(power.floor());
    // The fine lines fade out before the step grows tenfold.
    let fine_share = 1.0 - (power - power.floor());
    // Snapped to a crossing of strong lines, so that the grid stays fixed in the world when the camera moves.
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
