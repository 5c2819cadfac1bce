//! The display of a place where the shape passes through itself: the lines in which its triangles do.

use crate::view::{ControlShape, View};
use crate::workspace::Workspace;

/// A red that differs from clay and handles.
const COLOUR: [u8; 4] = [235, 30, 45, 255];

/// The lines of all places, while the present shape is shown.
pub(super) fn intersection_shapes(workspace: &Workspace, view: &View) -> Option<ControlShape> {
    let (camera, viewport_px) = (view.camera(), view.viewport_px());
    if view.look.original || view.look.base {
        return None;
    }
    let found = workspace.intersections().filter(|found| !found.is_empty())?;
    // They are moved towards the eye, so that the surface on either side does not hide them.
    let lifted = |point| point + camera.towards_eye(point) * camera.world_per_px(point, viewport_px);
    let segments = found.places.iter().flat_map(|place| &place.segments);
    let lines = segments.map(|ends| ends.map(lifted)).collect();
    Some(ControlShape::lines(COLOUR, lines))
}
