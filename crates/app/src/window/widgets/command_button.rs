//! A button for a command: its name, tooltip and shortcut come from the editor's list.

use std::borrow::Cow;

use eframe::egui::{self, AtomExt as _, Button, Role, Sense, Widget, WidgetInfo};
use pliant_editor::{Command, Editor};

use super::icon::{self, Glyph};

/// A button for a listed command, disabled when it is unavailable; true when it is clicked.
pub fn command_button(ui: &mut egui::Ui, editor: &Editor, command: &Command) -> bool {
    named_button(ui, editor, command, command)
}

/// A button for a command with the name and the tooltip of a listed one.
pub fn named_button(ui: &mut egui::Ui, editor: &Editor, command: &Command, like: &Command) -> bool {
    let Some(listed) = like.listed() else { return false };
    let mut button = Button::new(listed.name);
    if let Some(shortcut) = editor.shortcuts(command).first() {
        button = button.shortcut_text(shortcut.label());
    }
    enabled_unless(ui, editor.unavailable_because(command), button)
        .on_hover_text(listed.tooltip)
        .clicked()
}

/// The same as a choice that is marked while it is true.
pub fn command_choice(ui: &mut egui::Ui, editor: &Editor, command: &Command, chosen: bool) -> bool {
    let Some(listed) = command.listed() else { return false };
    choice(ui, editor, command, chosen, Button::selectable(chosen, listed.name))
}

/// The same in a menu, with a tick while it is true.
pub fn menu_choice(ui: &mut egui::Ui, editor: &Editor, command: &Command, chosen: bool) -> bool {
    let Some(listed) = command.listed() else { return false };
    let tick = icon::text(Glyph::Check, 13.0);
    let tick = if chosen {
        tick
    } else {
        tick.color(egui::Color32::TRANSPARENT)
    };
    let mut button = Button::new((tick, listed.name));
    if let Some(shortcut) = editor.shortcuts(command).first() {
        button = button.shortcut_text(shortcut.label());
    }
    choice(ui, editor, command, chosen, button)
}

/// The same with an icon, and with `label` beside it if there is room.
pub fn icon_choice(
    ui: &mut egui::Ui,
    editor: &Editor,
    command: &Command,
    chosen: bool,
    glyph: Glyph,
    label: Option<&str>,
) -> bool {
    let sign = icon::text(glyph, 16.0);
    let button = match label {
        Some(label) => Button::selectable(chosen, (sign, label)),
        None => Button::selectable(chosen, sign),
    };
    choice(ui, editor, command, chosen, button)
}

/// A button that plays or pauses, as wide in both states, so that its neighbours stay in place.
pub fn play_choice(ui: &mut egui::Ui, editor: &Editor, command: &Command, is_playing: bool) -> bool {
    const STATES: [(Glyph, &str); 2] = [(Glyph::Play, "Play"), (Glyph::Pause, "Pause")];
    let font = egui::TextStyle::Button.resolve(ui.style());
    let colour = egui::Color32::PLACEHOLDER;
    let sizes = STATES.map(|(_, label)| {
        ui.painter()
            .layout_no_wrap(label.to_owned(), font.clone(), colour)
            .size()
    });
    let (glyph, label) = STATES[usize::from(is_playing)];
    let label = label.atom_size(sizes[0].max(sizes[1]));
    let button = Button::selectable(is_playing, (icon::text(glyph, 16.0), label));
    choice(ui, editor, command, is_playing, button)
}

/// The same as a tile as wide as there is room: the icon, and beneath it the label if the tile is high enough.
pub fn tile_choice(
    ui: &mut egui::Ui,
    editor: &Editor,
    command: &Command,
    chosen: bool,
    glyph: Glyph,
    (label, height): (&str, f32),
) -> bool {
    let tile = |ui: &mut egui::Ui| {
        let size = egui::vec2(ui.available_width(), height);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click());
        let visuals = ui.style().interact_selectable(&response, chosen);
        let is_marked = chosen || response.hovered() || response.has_focus();
        if is_marked && ui.is_enabled() {
            let stroke = if response.has_focus() {
                visuals.bg_stroke
            } else {
                egui::Stroke::NONE
            };
            let inside = egui::StrokeKind::Inside;
            ui.painter()
                .rect(rect, visuals.corner_radius, visuals.weak_bg_fill, stroke, inside);
        }
        let has_label = height >= LABELLED_TILE;
        let middle = rect.center() - egui::vec2(0.0, if has_label { 8.0 } else { 0.0 });
        let (centre, colour) = (egui::Align2::CENTER_CENTER, visuals.text_color());
        ui.painter()
            .text(middle, centre, glyph.unicode(), icon::font(20.0), colour);
        if has_label {
            let font = egui::TextStyle::Small.resolve(ui.style());
            ui.painter()
                .text(middle + egui::vec2(0.0, 20.0), centre, label, font, colour);
        }
        response
    };
    choice(ui, editor, command, chosen, tile)
}

/// The least height of a tile with its label.
pub const LABELLED_TILE: f32 = 44.0;

/// A widget that is a choice of a listed command, with its name for screen readers.
fn choice(ui: &mut egui::Ui, editor: &Editor, command: &Command, chosen: bool, widget: impl Widget) -> bool {
    let Some(listed) = command.listed() else { return false };
    let tooltip = match editor.shortcuts(command).first() {
        Some(shortcut) => format!("{} ({})", listed.tooltip, shortcut.label()),
        None => listed.tooltip.to_owned(),
    };
    let obstacle = editor.unavailable_because(command);
    let is_enabled = obstacle.is_none();
    let response = enabled_unless(ui, obstacle, widget);
    response.widget_info(|| WidgetInfo::selected(Role::Button, is_enabled, chosen, listed.name));
    response.on_hover_text(tooltip).clicked()
}

/// A widget that is disabled for a reason, which its tooltip shows.
fn enabled_unless(ui: &mut egui::Ui, obstacle: Option<Cow<'_, str>>, button: impl Widget) -> egui::Response {
    let response = ui.add_enabled(obstacle.is_none(), button);
    match obstacle {
        Some(obstacle) => response.on_disabled_hover_text(&*obstacle),
        None => response,
    }
}

/// Choices among other widgets, where they wrap one by one, each with its name and meaning; returns the one that is
/// clicked.
pub fn choices<T: Copy + PartialEq>(ui: &mut egui::Ui, chosen: T, all: &[(T, &str, &str)]) -> Option<T> {
    let mut clicked = None;
    for (choice, name, meaning) in all {
        let label = ui.selectable_label(chosen == *choice, *name);
        if label.on_hover_text(*meaning).clicked() {
            clicked = Some(*choice);
        }
    }
    clicked
}
