//! The painted handle that a drag takes along, instead of painting it once more.

use super::mode::{StrokeShape, ToolMode};
use super::settings::ToolSettings;
use crate::document::Paint;
use crate::input::Modifiers;
use crate::view::Pick;
use crate::workspace::Workspace;

/// Whether a press with the brush of the Handle tool takes the selected handle: paint over its own vertices would change
/// nothing. With a modifier key the brush keeps its effect.
pub(super) fn is_taken_along(
    workspace: &Workspace,
    settings: &ToolSettings,
    pick: &Pick,
    modifiers: Modifiers,
) -> bool {
    let is_brush = settings.mode == ToolMode::PaintHandle && settings.stroke_shape == StrokeShape::Brush;
    let waits = settings.waits_for_press() || workspace.selection.wants_new_handle;
    workspace.selected().is_some_and(|handle| {
        let is_on_it = workspace.document.paint().get(pick.vertex.index()) == Some(&Paint::Handle(handle.id));
        let is_movable = !handle.locked && !handle.is_pin;
        is_brush && !waits && modifiers == Modifiers::NONE && is_on_it && is_movable
    })
}
