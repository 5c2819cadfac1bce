//! Handles that are held in the picture alone: free along the direction of sight.
//!
//! Such a handle stays under the pointer, and its distance from the eye follows from the shape. Its free direction is that
//! of sight at its last move, so it does not change when the camera does.

use glam::DVec3;

use super::state::Workspace;
use crate::document::{Handle, HandleId};
use crate::view::Camera;

/// Frees the selected handle along the direction of sight, or holds it again where it is.
pub(crate) fn free_or_hold_selected(workspace: &mut Workspace, camera: &Camera) {
    let Some(handle) = workspace.selected() else { return };
    let (id, is_held, has_no_line) = (handle.id, handle.free_along.is_none(), handle.line.is_none());
    let name = if is_held { "Free depth" } else { "Hold depth" };
    let direction = is_held.then(|| -camera.towards_eye(handle.centre()));
    workspace.change(name, |document| {
        if is_held && document.is_displaced() && has_no_line {
            document.unsettle();
        }
        document.change_handle(id, |handle| handle.free_along = direction);
    });
}

/// Turns the free directions of handles that were moved just now, and of their twins, into the directions of sight.
pub(crate) fn aim_free_handles(workspace: &mut Workspace, camera: &Camera, moved: impl Iterator<Item = HandleId>) {
    let document = &mut workspace.document;
    for id in moved {
        let Some(handle) = document.handle(id).filter(|handle| handle.free_along.is_some()) else {
            continue;
        };
        let (direction, twin) = (-camera.towards_eye(handle.centre()), handle.twin);
        let put = |direction: DVec3| move |handle: &mut Handle| handle.free_along = Some(direction);
        document.change_handle(id, put(direction));
        if let Some(twin) = twin.filter(|twin| document.handle(twin.handle).is_some_and(|own| own.free_along.is_some()))
        {
            document.change_handle(twin.handle, put(twin.plane.mirrored_vector(direction)));
        }
    }
}
