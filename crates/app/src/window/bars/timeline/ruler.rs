//! The ruler of the timeline: a drag along it shows the moment under the pointer.

use eframe::egui::{self, Align2, FontId, Rect, Sense, Stroke};
use pliant_editor::{Command, Editor};

use super::scale::TimeScale;
use crate::window::widgets::outbox::Outbox;

/// The height of the ruler.
pub const HEIGHT: f32 = 20.0;

/// Shows the ruler in `rect` with the scale's times.
pub fn show(ui: &egui::Ui, rect: Rect, scale: &TimeScale, editor: &Editor, commands: &mut Outbox) {
    let animation = editor.document().animation();
    marks(ui, rect, scale, animation.fps());
    let response = ui.interact(rect, egui::Id::unique("ruler of the timeline"), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, "Shown moment"));
    if response.double_clicked() {
        TimeScale::fit(ui.ctx());
    }
    let mut response = response.on_hover_text(match animation.frames() {
        Some(_) => "Drag to show a frame; double-click to show all frames.",
        None => "Drag to show a moment; double-click to show all keys.",
    });
    let Some(pointer) = response.interact_pointer_pos() else {
        return commands.adjust(&response, || Command::GoToTime(animation.time()));
    };
    let time = animation.snapped(scale.time_of(pointer.x));
    if (response.dragged() || response.clicked()) && time != animation.time() {
        response.mark_changed();
    }
    commands.adjust(&response, || Command::GoToTime(time));
}

fn marks(ui: &egui::Ui, rect: Rect, scale: &TimeScale, fps: f64) {
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    let visuals = ui.visuals();
    painter.rect_filled(rect, 3.0, visuals.extreme_bg_color);
    let step = scale.frames_a_mark(fps);
    let mut frame = (scale.from.max(0.0) * fps / step).floor() * step;
    let font = FontId::proportional(10.5);
    while frame / fps <= scale.to {
        let x = scale.x_of(frame / fps);
        let line = Stroke::new(1.0, visuals.weak_text_color().gamma_multiply(0.6));
        painter.vline(x, rect.bottom() - 6.0..=rect.bottom(), line);
        let at = egui::pos2(x, rect.top() + 7.0);
        painter.text(
            at,
            Align2::CENTER_CENTER,
            format!("{frame}"),
            font.clone(),
            visuals.weak_text_color(),
        );
        frame += step;
    }
}
