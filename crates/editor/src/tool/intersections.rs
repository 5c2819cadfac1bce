//! How a place is shown where the shape passes through itself: the lines in which its triangles do.

use crate::view::{Camera, ControlShape};
use crate::workspace::Workspace;
use glam::DVec2;

/// A red that neither clay nor handles have.
const COLOUR: [u8; 4] = [235, 30, 45, 255];

/// The lines of all places.
pub(super) fn intersection_shapes(workspace: &Workspace, camera: &Camera, viewport_px: DVec2) -> Option<ControlShape> {
    let found = workspace.intersections().filter(|found| !found.is_empty())?;
    // Moved towards the eye, so that the surface on either side does not hide them.
    let lifted = |point| point + camera.towards_eye(point) * camera.world_per_px(point, viewport_px);
    let segments = found.places.iter().flat_map(|place| &place.segments);
    Some(ControlShape {
        colour: COLOUR,
        lines: segments.map(|ends| ends.map(lifted)).collect(),
        triangles: Vec::new(),
    })
}
