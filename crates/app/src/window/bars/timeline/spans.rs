//! The spans of a sequence's keys: bars in the rows, whose ends can be dragged.

use std::collections::BTreeMap;

use eframe::egui::{self, Color32, CursorIcon, Rangef, Rect, Sense};
use pliant_editor::{Command, Editor, Handle, KeyId};

use super::scale::TimeScale;
use crate::window::widgets::outbox::Outbox;

/// Half the height of a bar.
const HALF_HEIGHT: f32 = 4.0;

/// The width of the grip at an end of a bar.
const GRIP: f32 = 8.0;

/// Shows the spans of a handle's keys in its row.
pub fn show(ui: &egui::Ui, row: Rect, scale: &TimeScale, editor: &Editor, handle: &Handle, commands: &mut Outbox) {
    let animation = editor.document().animation();
    let mut spans: BTreeMap<[usize; 2], KeyId> = BTreeMap::new();
    for key in animation.keys() {
        if let Some(span) = key.span(handle.id) {
            spans.entry(span).or_insert(KeyId::new(handle.id, key.time));
        }
    }
    let x_of = |frame: usize| scale.x_of(frame as f64 / animation.fps());
    let [red, green, blue, _] = handle.colour;
    let colour = Color32::from_rgb(red, green, blue);
    let painter = ui.painter().with_clip_rect(row.intersect(ui.clip_rect()));
    for (span, key) in spans {
        let [from, to] = span.map(x_of);
        let y = row.center().y;
        let bar = Rect::from_x_y_ranges(
            Rangef::new(from, to.max(from + 2.0)),
            Rangef::new(y - HALF_HEIGHT, y + HALF_HEIGHT),
        );
        painter.rect_filled(bar, HALF_HEIGHT, colour.gamma_multiply(0.3));
        for (side, x) in [from, to].into_iter().enumerate() {
            // Outside of the bar, so that a key at its end can be reached.
            let left = if side == 0 { x - GRIP } else { x };
            let grip = Rect::from_x_y_ranges(Rangef::new(left, left + GRIP), row.y_range()).intersect(row);
            if !grip.is_positive() {
                continue;
            }
            let id = egui::Id::unique(("end of a span", handle.id.0, key.time().to_bits(), side));
            let mut response = ui.interact(grip, id, Sense::drag());
            let end = if side == 0 { "First" } else { "Last" };
            let label = format!("{end} frame that a key of {} reaches", handle.name);
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, &label));
            let is_lit = response.hovered() || response.dragged();
            let stroke = egui::Stroke::new(if is_lit { 3.0 } else { 1.5 }, colour);
            painter.vline(x, bar.y_range(), stroke);
            if is_lit {
                ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
            }
            let mut ends = span;
            if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
                let frame = (animation.snapped(scale.time_of(pointer.x)) * animation.fps()).round() as usize;
                ends[side] = frame;
            }
            if ends != span && ends[0] <= ends[1] {
                response.mark_changed();
            }
            commands.adjust(&response, || Command::SetSpan(key, ends));
            response.on_hover_text(format!(
                "{label}: {}. Drag to spread the edit farther or less far.",
                span[side]
            ));
        }
    }
}
