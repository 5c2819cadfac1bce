//! The row of the body's path: a mark for each frame at which it is moved.

use eframe::egui::{self, Rect, Sense, Stroke, StrokeKind, vec2};
use pliant_editor::{Command, Editor};

use super::scale::TimeScale;
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::theme;

/// Half the side of a mark.
const MARK: f32 = 4.0;

/// Returns true if the path has a row.
pub fn is_shown(editor: &Editor) -> bool {
    editor.view().look.path && editor.document().animation().frames().is_some()
}

/// Shows the row's name and its marks: a click shows the frame, and a menu removes it from the path.
pub fn show(ui: &egui::Ui, row: Rect, scale: &TimeScale, editor: &Editor, commands: &mut Outbox) {
    let painter = ui.painter().with_clip_rect(row.intersect(ui.clip_rect()));
    let font = egui::TextStyle::Body.resolve(ui.style());
    let at = egui::pos2(row.left() + 4.0, row.center().y);
    let colour = ui.visuals().text_color();
    painter.text(at, egui::Align2::LEFT_CENTER, "Path", font, colour);
    let animation = editor.document().animation();
    let Some(path) = animation.path() else {
        let at = egui::pos2(scale.x.min + 6.0, row.center().y);
        let font = egui::TextStyle::Small.resolve(ui.style());
        let hint = "Drag the line on the ground in the view to bend the way of the whole body.";
        let weak = ui.visuals().weak_text_color();
        painter.text(at, egui::Align2::LEFT_CENTER, hint, font, weak);
        return;
    };
    let canvas = row.with_min_x(scale.x.min);
    for (frame, shift) in path.shifts() {
        let centre = egui::pos2(scale.x_of(frame as f64 / animation.fps()), row.center().y);
        let grip = Rect::from_center_size(centre, vec2(2.0 * MARK + 4.0, row.height())).intersect(canvas);
        if !grip.is_positive() {
            continue;
        }
        let response = ui.interact(grip, egui::Id::unique(("place of the path", frame)), Sense::click());
        let label = format!("The path is moved by {:.4} at frame {frame}", shift.length());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
        let fill = match response.hovered() || frame == animation.frame() {
            true => theme::ACCENT,
            false => ui.visuals().widgets.inactive.fg_stroke.color,
        };
        let square = Rect::from_center_size(centre, vec2(2.0 * MARK, 2.0 * MARK));
        let line = Stroke::new(1.0, ui.visuals().extreme_bg_color);
        painter.rect(square, 1.0, fill, line, StrokeKind::Inside);
        if response.clicked() {
            commands.push(Command::GoToTime(frame as f64 / animation.fps()));
        }
        response.context_menu(|ui| {
            if ui.button("Remove from the path").clicked() {
                commands.push(Command::FreePath(frame));
                ui.close();
            }
        });
        response.on_hover_text(format!("{label}: click to show it, right-click to remove it."));
    }
}
