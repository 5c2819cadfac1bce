//! The button that Enter presses: filled, so that it is recognised at a glance.

use eframe::egui::{self, Button, RichText};

/// A button of this name in the colours of the selection.
pub fn default_button(ui: &egui::Ui, name: &str) -> Button<'static> {
    let selection = ui.visuals().selection;
    let text = RichText::new(name).strong().color(selection.stroke.color);
    Button::new(text).fill(selection.bg_fill)
}
