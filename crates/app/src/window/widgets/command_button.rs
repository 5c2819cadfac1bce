//! A button for a command: its name, tooltip and shortcut come from the editor's list.

use std::borrow::Cow;

use eframe::egui::{self, Button};
use pliant_editor::{Command, Editor};

/// A button for a listed command, disabled when it can't be done now; true when it is clicked.
pub fn command_button(ui: &mut egui::Ui, editor: &Editor, command: &Command) -> bool {
    let Some(listed) = command.listed() else { return false };
    let mut button = Button::new(listed.name);
    if let Some(shortcut) = editor.shortcuts(command).first() {
        button = button.shortcut_text(shortcut.label());
    }
    enabled_unless(ui, editor.unavailable_because(command), button)
        .on_hover_text(listed.tooltip)
        .clicked()
}

/// The same as a choice that is marked while it holds.
pub fn command_choice(ui: &mut egui::Ui, editor: &Editor, command: &Command, chosen: bool) -> bool {
    let Some(listed) = command.listed() else { return false };
    let tooltip = match editor.shortcuts(command).first() {
        Some(shortcut) => format!("{} ({})", listed.tooltip, shortcut.label()),
        None => listed.tooltip.to_owned(),
    };
    let button = Button::selectable(chosen, listed.name);
    enabled_unless(ui, editor.unavailable_because(command), button)
        .on_hover_text(tooltip)
        .clicked()
}

/// A button that is greyed out with a reason, which its tooltip shows.
fn enabled_unless(ui: &mut egui::Ui, obstacle: Option<Cow<'_, str>>, button: Button<'_>) -> egui::Response {
    let response = ui.add_enabled(obstacle.is_none(), button);
    match obstacle {
        Some(obstacle) => response.on_disabled_hover_text(&*obstacle),
        None => response,
    }
}

/// Choices side by side, each with its name and what it means; the one that is clicked.
pub fn choices<T: Copy + PartialEq>(ui: &mut egui::Ui, chosen: T, all: &[(T, &str, &str)]) -> Option<T> {
    let mut clicked = None;
    ui.horizontal(|ui| {
        for (choice, name, meaning) in all {
            if ui
                .selectable_label(chosen == *choice, *name)
                .on_hover_text(*meaning)
                .clicked()
            {
                clicked = Some(*choice);
            }
        }
    });
    clicked
}
