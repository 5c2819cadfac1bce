//! The column at the left: the tools in the order of their keys, then the gizmo's modes.

use eframe::egui::{self, ScrollArea};
use pliant_editor::{Command, Editor, GizmoOrientation, ToolMode};

use crate::window::widgets::command_button::{LABELLED_TILE, tile_choice};
use crate::window::widgets::icon::Glyph;
use crate::window::widgets::outbox::Outbox;

/// The width.
pub const WIDTH: f32 = 68.0;

/// The possible heights of tiles: an icon alone, and an icon with its label and some space.
const HEIGHTS: [f32; 2] = [22.0, 54.0];

/// Space between two tiles.
const GAP: f32 = 2.0;

/// Shows the column. Commands are added to `commands`.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let chosen = editor.view().tool;
    let tools = [
        (ToolMode::PaintHandle, Glyph::Hand, "Handle"),
        (ToolMode::PaintFree, Glyph::PaintbrushVertical, "Region"),
        (ToolMode::PaintFixed, Glyph::Anchor, "Fixed"),
        (ToolMode::Erase, Glyph::Eraser, "Erase"),
        (ToolMode::Select, Glyph::SquareDashedMousePointer, "Select"),
        (ToolMode::PaintStiffness, Glyph::Bone, "Stiffness"),
        (ToolMode::Pose, Glyph::PersonStanding, "Pose"),
        (ToolMode::Correct, Glyph::Brush, "Correct"),
        (ToolMode::Flow, Glyph::Droplets, "Flow"),
    ]
    .map(|(tool, glyph, label)| (Command::SetTool(tool), chosen == tool, glyph, label));
    let modes = [
        (Command::Move, Glyph::Move3d, "Move"),
        (Command::Turn, Glyph::Rotate3d, "Turn"),
        (Command::Scale, Glyph::Scale3d, "Scale"),
    ]
    .map(|(command, glyph, label)| (command, false, glyph, label));
    // The tile shows the gizmo's axes, and a click takes the next ones.
    let (next, glyph, label) = match editor.view().orientation {
        GizmoOrientation::World => (GizmoOrientation::Local, Glyph::Globe, "World"),
        GizmoOrientation::Local => (GizmoOrientation::View, Glyph::Axis3d, "Own"),
        GizmoOrientation::View => (GizmoOrientation::World, Glyph::Monitor, "Screen"),
    };
    let [mode_move, mode_turn, mode_scale] = modes;
    let axes = (Command::SetOrientation(next), false, glyph, label);
    let modes = [mode_move, mode_turn, mode_scale, axes];
    let count = (tools.len() + modes.len()) as f32;
    let room = (ui.available_height() - 12.0) / count - GAP;
    let height = room.clamp(HEIGHTS[0], HEIGHTS[1]);
    // All labels appear or none.
    let height = if height < LABELLED_TILE { HEIGHTS[0] } else { height };
    ui.spacing_mut().item_spacing.y = GAP;
    ScrollArea::vertical().show(ui, |ui| {
        ui.add_space(4.0);
        for (number, group) in [&tools[..], &modes].into_iter().enumerate() {
            if number > 0 {
                ui.separator();
            }
            for (command, is_chosen, glyph, label) in group {
                if tile_choice(ui, editor, command, *is_chosen, *glyph, (label, height)) {
                    commands.push(command.clone());
                }
            }
        }
    });
}
