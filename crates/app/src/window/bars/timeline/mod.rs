//! The timeline under the view: play and the shown moment, a ruler, and the keys of the handles in rows.

mod path_row;
mod row;
mod rows;
mod ruler;
mod scale;
mod spans;
mod transport;
mod way_line;

use eframe::egui::scroll_area::ScrollBarVisibility;
use eframe::egui::{self, Panel, Rangef, Rect, ScrollArea, Stroke, vec2};
use pliant_editor::{Command, Editor};

use self::scale::TimeScale;
use crate::window::input::event_queue::EventQueue;
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::theme;

/// The room for the names of handles.
const NAMES: f32 = 120.0;

/// The change of the shown stretch by a notch of the wheel with Ctrl.
const ZOOM: f64 = 1.2;

/// Shows the strip if it is wanted and a file is open. Returns its place.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) -> Rect {
    let view = editor.view();
    if !view.look.timeline || view.model.is_none() {
        return Rect::NOTHING;
    }
    let strip = Panel::bottom("timeline")
        .default_size(132.0)
        .min_size(86.0)
        .resizable(true)
        .show(ui, |ui| contents(ui, editor, commands));
    strip.response.rect
}

fn contents(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    ui.spacing_mut().item_spacing.y = 2.0;
    ui.add_space(2.0);
    // In a narrow window it must not make the ruler wider than the strip.
    ScrollArea::horizontal()
        .id_salt("buttons of the timeline")
        .auto_shrink([false, true])
        .scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden)
        .show(ui, |ui| transport::show(ui, editor, commands));
    ScrollArea::horizontal()
        .id_salt("way of the timeline")
        .auto_shrink([false, true])
        .scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden)
        .show(ui, |ui| way_line::show(ui, editor, commands));
    let animation = editor.document().animation();
    let size = vec2(ui.available_width(), ruler::HEIGHT);
    let (line, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    let x = Rangef::new(line.left() + NAMES, line.right() - 8.0);
    let scale = TimeScale::of(ui.ctx(), animation, x);
    let line = Rect::from_x_y_ranges(x, line.y_range());
    ruler::show(ui, line, &scale, editor, commands);
    let rows = ScrollArea::vertical()
        .auto_shrink([false, false])
        .show(ui, |ui| rows::show(ui, &scale, editor, commands));
    let whole = line.union(rows.inner_rect);
    playhead(ui, Rect::from_x_y_ranges(x, whole.y_range()), &scale, animation.time());
    move_stretch(ui, whole, &scale);
    keys(ui, whole, editor, commands);
}

fn playhead(ui: &egui::Ui, rect: Rect, scale: &TimeScale, time: f64) {
    let x = scale.x_of(time);
    if !rect.x_range().contains(x) {
        return;
    }
    let painter = ui.painter();
    painter.vline(x, rect.y_range(), Stroke::new(1.5, theme::ACCENT));
    let top = egui::pos2(x, rect.top() + 12.0);
    let corners = vec![top, top + vec2(-6.0, -9.0), top + vec2(6.0, -9.0)];
    painter.add(egui::Shape::convex_polygon(corners, theme::ACCENT, Stroke::NONE));
}

/// Ctrl and the wheel show a shorter or longer stretch, Shift and the wheel an earlier or later one.
fn move_stretch(ui: &egui::Ui, rect: Rect, scale: &TimeScale) {
    let Some(pointer) = ui
        .input(|input| input.pointer.hover_pos())
        .filter(|at| rect.contains(*at))
    else {
        return;
    };
    let (zoom, scroll) = ui.input(|input| (f64::from(input.zoom_delta()), input.smooth_scroll_delta()));
    if zoom != 1.0 {
        let factor = zoom.clamp(1.0 / ZOOM, ZOOM).recip();
        scale.zoom(ui.ctx(), scale.time_of(pointer.x), factor);
    } else if scroll.x != 0.0 {
        scale.pan(ui.ctx(), -scale.seconds_of(scroll.x));
    }
}

/// While the pointer is over the strip, Delete and the keys to copy and to paste are the keys' own.
fn keys(ui: &egui::Ui, rect: Rect, editor: &Editor, commands: &mut Outbox) {
    let is_over = ui
        .input(|input| input.pointer.hover_pos())
        .is_some_and(|at| rect.contains(at));
    if !is_over || EventQueue::is_typing(ui.ctx()) || ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    let taken = |event: &egui::Event| match event {
        egui::Event::Copy => Some(Command::CopyKeys),
        egui::Event::Paste(_) => Some(Command::PasteKeys),
        egui::Event::Key {
            key: egui::Key::Delete | egui::Key::X,
            pressed: true,
            modifiers,
            ..
        } if modifiers.is_none() => Some(Command::DeleteKeys),
        egui::Event::Key {
            key: egui::Key::A,
            pressed: true,
            modifiers,
            ..
        } if modifiers.is_none() => Some(Command::SelectAllKeys),
        _ => None,
    };
    ui.input_mut(|input| {
        input.events.retain(|event| match taken(event) {
            Some(command) if editor.is_enabled(&command) => {
                commands.push(command);
                false
            }
            _ => true,
        });
    });
}
