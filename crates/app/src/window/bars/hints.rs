//! The first steps, on the canvas, until a person closes them or has done them.

use eframe::egui::{self, Align2, Color32, RichText};
use pliant_editor::{Editor, ToolMode};

/// The largest width of a hint, in points.
const WIDTH: f32 = 330.0;

/// The least area of a view, in square points, that shows a hint's words at all times. A whole card covers 40,000. In a
/// smaller view it has its title alone until the pointer is over it.
const ROOMY: f32 = 250_000.0;

/// Shows the next step in the view's lower left corner, above `toast`; true when the person closes the hints for good.
pub fn show(ui: &egui::Ui, view_rect: egui::Rect, toast: Option<egui::Rect>, editor: &Editor) -> bool {
    let view = editor.view();
    if view.model.is_none() {
        return false;
    }
    let is_sequence = editor.document().animation().frames().is_some();
    let is_posing = view.tool == ToolMode::Pose;
    let is_bent = editor.document().is_displaced() || (editor.document().is_applied() && !is_sequence);
    let (number, title, words) = if is_posing && !is_bent {
        (
            1,
            "Drag a limb",
            "Point at a limb: what will turn is tinted, and Ctrl with the wheel moves its joint. Then drag it. Turn \
             the view with Alt, or drag beside the model.",
        )
    } else if is_posing && view.handles.len() == 1 {
        (
            2,
            "Go on",
            "Ctrl twists a limb and Shift scales it while you drag. Drag above or below the joint for the next one; \
             Symmetry (Shift+X) bends both sides.",
        )
    } else if view.handles.is_empty() {
        (
            1,
            "Paint a handle",
            "Hold the left button over the part to move, or press 7 and drag a limb. Turn the view with Alt, or drag \
             beside the model.",
        )
    } else if !is_bent {
        (
            2,
            "Drag it",
            "Point at an arrow or a ring and drag it, or press G, R or S. Then x, y or z chooses an axis, and digits \
             set the amount.",
        )
    } else if is_sequence {
        (
            3,
            "Set a key",
            "Press I: the key spreads over the frames around this one. Drag along the ruler to see them; File has \
             Export frames…",
        )
    } else {
        (
            3,
            "Save",
            "Ctrl+S saves the model and keeps the original beside it. F1 finds every command by its name.",
        )
    };
    let mut put_away = false;
    let corner = view_rect.left_bottom() + egui::vec2(16.0, -16.0);
    let floor = toast
        .filter(|toast| toast.left() < corner.x + WIDTH)
        .map_or(corner.y, |toast| toast.top() - 8.0);
    let id = egui::Id::unique("hint");
    let card = ui.memory(|memory| memory.area_rect(id));
    let pointer = ui.input(|input| input.pointer.hover_pos());
    let is_pointed_at = card.zip(pointer).is_some_and(|(card, pointer)| card.contains(pointer));
    let is_whole = view_rect.area() >= ROOMY || is_pointed_at;
    egui::Area::new(id)
        .fixed_pos(egui::pos2(corner.x, floor))
        .pivot(Align2::LEFT_BOTTOM)
        .show(ui.ctx(), |ui| {
            egui::Frame::popup(ui.style())
                .fill(ui.visuals().window_fill.gamma_multiply(0.94))
                .inner_margin(12.0)
                .show(ui, |ui| {
                    ui.set_max_width(WIDTH - 24.0);
                    ui.horizontal(|ui| {
                        ui.label(RichText::new(format!("{number} of 3")).weak().small());
                        ui.label(RichText::new(title).strong().color(accent(ui)));
                        if !is_whole {
                            ui.label(RichText::new("…").weak());
                        }
                    });
                    if is_whole {
                        ui.label(words);
                        put_away = ui.small_button("Hide hints").clicked();
                    }
                });
        });
    put_away
}

fn accent(ui: &egui::Ui) -> Color32 {
    ui.visuals().hyperlink_color
}
