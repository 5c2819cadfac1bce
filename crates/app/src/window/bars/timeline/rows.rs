//! The rows of keys: one of all, one of each handle, and those of the strength and of the weights of examples if they have
//! keys.

use std::collections::BTreeSet;

use eframe::egui::{self, Color32, Pos2, Rect, Sense, Stroke, StrokeKind, vec2};
use pliant_editor::{Command, Ease, Editor, KeyFrame, KeyId, KeySpace};

use super::path_row;
use super::row::{Row, rows_of};
use super::scale::TimeScale;
use super::spans;
use crate::window::widgets::command_button::command_button;
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::theme;

/// The height of a row.
const HEIGHT: f32 = 20.0;

/// Half the side of a key's mark.
const MARK: f32 = 5.0;

/// Shows the rows; names are at the left of the scale.
pub fn show(ui: &mut egui::Ui, scale: &TimeScale, editor: &Editor, commands: &mut Outbox) {
    let own = rows_of(editor);
    let has_path = path_row::is_shown(editor);
    let rows = own.len() + usize::from(has_path);
    let size = vec2(ui.available_width(), HEIGHT * rows as f32);
    let (whole, _) = ui.allocate_exact_size(size, Sense::hover());
    let canvas = whole.with_min_x(scale.x.min);
    // Under the keys, which come after it.
    let ground = ui.interact(
        canvas,
        egui::Id::unique("rows of the timeline"),
        Sense::click_and_drag(),
    );
    let mut marks = Vec::new();
    let rect_of = |row: usize| {
        let top = whole.top() + HEIGHT * row as f32;
        Rect::from_min_size(egui::pos2(whole.left(), top), vec2(whole.width(), HEIGHT))
    };
    if has_path {
        let rect = rect_of(rows - 1);
        stripe(ui, rect.with_min_x(scale.x.min), rows - 1);
        path_row::show(ui, rect, scale, editor, commands);
    }
    for (number, row) in own.into_iter().enumerate() {
        let rect = rect_of(number);
        stripe(ui, rect.with_min_x(scale.x.min), number);
        name(ui, rect.with_max_x(scale.x.min - 4.0), row, editor, commands);
        if let Row::Handle(handle) = row {
            spans::show(ui, rect.with_min_x(scale.x.min), scale, editor, handle, commands);
        }
        for key in editor.document().animation().keys() {
            let own = row.keys_in(editor, key);
            if !own.is_empty() {
                let at = egui::pos2(scale.x_of(key.time), rect.center().y);
                marks.push(Mark { own, at, row, key });
            }
        }
    }
    let moved = dragged_time(ui, scale, editor);
    for mark in &marks {
        mark.show(ui, canvas, scale, editor, moved, commands);
    }
    choose_in_box(ui, &ground, &marks, editor, commands);
    ground.context_menu(|ui| menu(ui, editor, commands));
}

/// A key of a row: of one handle, or all of a moment.
struct Mark<'a> {
    own: Vec<KeyId>,
    at: Pos2,
    row: Row<'a>,
    key: &'a KeyFrame,
}

impl Mark<'_> {
    /// Shows the key; it can be clicked, and dragged with the other selected ones.
    fn show(
        &self,
        ui: &egui::Ui,
        canvas: Rect,
        scale: &TimeScale,
        editor: &Editor,
        moved: Option<f64>,
        commands: &mut Outbox,
    ) {
        let selected = editor.view().selected_keys;
        let is_selected = self.own.iter().all(|id| selected.contains(id));
        let id = egui::Id::unique(("key", self.row.of_keys(), self.key.time.to_bits()));
        let grip = Rect::from_center_size(self.at, vec2(2.0 * MARK + 4.0, HEIGHT)).intersect(canvas);
        if !grip.is_positive() {
            return;
        }
        let response = ui.interact(grip, id, Sense::click_and_drag());
        let whose = match self.row {
            Row::All => "all".to_owned(),
            Row::Handle(handle) => handle.name.clone(),
            Row::Strength => format!("the strength, {:.0} %,", 100.0 * self.key.strength().unwrap_or(1.0)),
            Row::Weights => "the weights".to_owned(),
        };
        let animation = editor.document().animation();
        let label = match animation.frames() {
            Some(_) => format!("Key of {whose} at frame {}", animation.frame_of(self.key)),
            None => format!("Key of {whose} at {:.3} s", self.key.time),
        };
        response.widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, is_selected, &label));
        let is_added = ui.input(|input| input.modifiers.shift);
        if response.clicked() || (response.drag_started() && !is_selected) {
            commands.push(Command::SelectKeys(chosen(
                selected,
                &self.own,
                is_added,
                response.clicked(),
            )));
        }
        if response.dragged()
            && let Some(by) = drag_of(ui, scale, editor)
        {
            ui.data_mut(|data| data.insert_temp(drag(), (id, by)));
            ui.ctx().set_cursor_icon(egui::CursorIcon::ResizeHorizontal);
        }
        if response.drag_stopped() {
            // The press is forgotten by now.
            let last: Option<(egui::Id, f64)> = ui.data(|data| data.get_temp(drag()));
            ui.data_mut(|data| data.remove::<(egui::Id, f64)>(drag()));
            if let Some((_, by)) = last.filter(|(_, by)| *by != 0.0) {
                commands.push(Command::MoveKeys(by));
            }
        }
        response.context_menu(|ui| menu(ui, editor, commands));
        let shown_at = match moved.filter(|_| self.own.iter().any(|id| selected.contains(id))) {
            Some(by) => egui::pos2(scale.x_of((self.key.time + by).max(0.0)), self.at.y),
            None => self.at,
        };
        let is_lit = is_selected || response.hovered();
        paint(ui, canvas, shown_at, self.key.ease, is_lit);
        response.on_hover_text(format!("{label}: drag to move, Shift to select more."));
    }
}

/// The selection after a press on keys: with Shift they are added, or removed if a click finds them selected.
fn chosen(selected: &BTreeSet<KeyId>, own: &[KeyId], is_added: bool, is_click: bool) -> Vec<KeyId> {
    if !is_added {
        return own.to_vec();
    }
    let are_all = own.iter().all(|id| selected.contains(id));
    if are_all && is_click {
        return selected.iter().copied().filter(|id| !own.contains(id)).collect();
    }
    selected.iter().chain(own).copied().collect()
}

/// The time by which the selected keys are being dragged.
fn dragged_time(ui: &egui::Ui, scale: &TimeScale, editor: &Editor) -> Option<f64> {
    let held: Option<(egui::Id, f64)> = ui.data(|data| data.get_temp(drag()));
    held.filter(|(id, _)| ui.ctx().is_being_dragged(*id))?;
    drag_of(ui, scale, editor)
}

/// The time between the press and the pointer, in whole frames.
fn drag_of(ui: &egui::Ui, scale: &TimeScale, editor: &Editor) -> Option<f64> {
    let (from, to) = ui.input(|input| (input.pointer.press_origin(), input.pointer.latest_pos()));
    let fps = editor.document().animation().fps();
    let by = scale.seconds_of(to?.x - from?.x);
    Some((by * fps).round() / fps)
}

fn drag() -> egui::Id {
    egui::Id::unique("dragged key of the timeline")
}

/// A drag beside the keys selects those in its box; a click selects none.
fn choose_in_box(ui: &egui::Ui, ground: &egui::Response, marks: &[Mark<'_>], editor: &Editor, commands: &mut Outbox) {
    let id = egui::Id::unique("box of the timeline");
    if ground.drag_started() {
        let from = ui.input(|input| input.pointer.press_origin());
        ui.data_mut(|data| data.insert_temp(id, from.unwrap_or_default()));
    }
    let from: Option<Pos2> = ui.data(|data| data.get_temp(id));
    let (Some(from), Some(to)) = (from, ui.input(|input| input.pointer.latest_pos())) else {
        if ground.clicked() {
            commands.push(Command::SelectKeys(Vec::new()));
        }
        return;
    };
    let chosen_box = Rect::from_two_pos(from, to);
    if ground.dragged() {
        let painter = ui.painter();
        painter.rect(
            chosen_box,
            0.0,
            theme::ACCENT.gamma_multiply(0.12),
            Stroke::new(1.0, theme::ACCENT),
            StrokeKind::Inside,
        );
    }
    if ground.drag_stopped() {
        ui.data_mut(|data| data.remove::<Pos2>(id));
        let within = marks.iter().filter(|mark| chosen_box.contains(mark.at));
        let own: Vec<KeyId> = within.flat_map(|mark| mark.own.iter().copied()).collect();
        let is_added = ui.input(|input| input.modifiers.shift);
        commands.push(Command::SelectKeys(chosen(
            editor.view().selected_keys,
            &own,
            is_added,
            false,
        )));
    } else if !ground.dragged() {
        ui.data_mut(|data| data.remove::<Pos2>(id));
    }
}

/// The menu over keys and beside them.
fn menu(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let eases = [Ease::Smooth, Ease::Linear, Ease::Hold].map(Command::SetKeyEase);
    let is_sequence = editor.document().animation().frames().is_some();
    let spaces = [KeySpace::Local, KeySpace::World].map(Command::SetKeySpace);
    let groups = [
        vec![
            Command::KeyHere,
            Command::KeySelected,
            Command::KeyStrength,
            Command::KeyWeights,
        ],
        vec![
            Command::CopyKeys,
            Command::PasteKeys,
            Command::DeleteKeys,
            Command::SelectAllKeys,
        ],
        eases.to_vec(),
        spaces.into_iter().filter(|_| is_sequence).collect(),
    ];
    for (number, group) in groups.into_iter().enumerate() {
        if number > 0 && !group.is_empty() {
            ui.separator();
        }
        for command in group {
            if command_button(ui, editor, &command) {
                commands.push(command);
                ui.close();
            }
        }
    }
}

/// The name of a row; a click selects its handle.
fn name(ui: &egui::Ui, rect: Rect, row: Row<'_>, editor: &Editor, commands: &mut Outbox) {
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    let handle = match row {
        Row::Handle(handle) => Some(handle),
        _ => None,
    };
    let is_selected = handle.is_some_and(|handle| editor.view().selected == Some(handle.id));
    let colour = match (row, is_selected) {
        (_, true) => ui.visuals().strong_text_color(),
        (Row::All, false) => ui.visuals().weak_text_color(),
        (_, false) => ui.visuals().text_color(),
    };
    let mut left = rect.left() + 4.0;
    if let Some(handle) = handle {
        let [red, green, blue, _] = handle.colour;
        let dot = egui::pos2(left + 5.0, rect.center().y);
        painter.circle_filled(dot, 4.0, Color32::from_rgb(red, green, blue));
        left += 15.0;
    }
    let at = egui::pos2(left, rect.center().y);
    let font = egui::TextStyle::Body.resolve(ui.style());
    painter.text(at, egui::Align2::LEFT_CENTER, row.name(), font, colour);
    let Some(handle) = handle else { return };
    let id = egui::Id::unique(("row of the timeline", handle.id.0));
    let response = ui.interact(rect, id, Sense::click());
    let label = format!("Row of {}", handle.name);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_selected, &label));
    if response.clicked() {
        commands.push(Command::SelectHandle(handle.id));
    }
}

fn stripe(ui: &egui::Ui, rect: Rect, row: usize) {
    let fill = match row % 2 {
        0 => ui.visuals().extreme_bg_color,
        _ => ui.visuals().faint_bg_color,
    };
    ui.painter().rect_filled(rect.shrink2(vec2(0.0, 0.5)), 2.0, fill);
}

/// A key's mark: a disc for a smooth way to the next, a diamond for a straight one, a square if it holds.
fn paint(ui: &egui::Ui, canvas: Rect, at: Pos2, ease: Ease, is_lit: bool) {
    let painter = ui
        .painter()
        .with_clip_rect(canvas.expand(MARK).intersect(ui.clip_rect()));
    let fill = match is_lit {
        true => theme::ACCENT,
        false => ui.visuals().widgets.inactive.fg_stroke.color,
    };
    let line = Stroke::new(1.0, ui.visuals().extreme_bg_color);
    match ease {
        Ease::Smooth => drop(painter.circle(at, MARK, fill, line)),
        Ease::Linear => {
            let way = 1.25 * MARK;
            let corners = [vec2(0.0, -way), vec2(way, 0.0), vec2(0.0, way), vec2(-way, 0.0)];
            let corners = corners.map(|corner| at + corner).to_vec();
            painter.add(egui::Shape::convex_polygon(corners, fill, line));
        }
        Ease::Hold => {
            let square = Rect::from_center_size(at, vec2(1.8 * MARK, 1.8 * MARK));
            painter.rect(square, 1.0, fill, line, StrokeKind::Inside);
        }
    }
}
