//! The shown share of the edit, as a slider.

use eframe::egui;
use pliant_editor::{Command, Editor};

use crate::window::widgets::command_button::icon_choice;
use crate::window::widgets::icon::Glyph;
use crate::window::widgets::number_field::{number_field, slid};
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::row_label::row_label;

/// Shows the slider. It is disabled while nothing is bent.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let mut percent = editor.document().strength() * 100.0;
    let obstacle = editor.unavailable_because(&Command::SetStrength(0.5));
    ui.horizontal(|ui| {
        let label = row_label(ui, "Strength");
        let slider = number_field(ui, &mut percent, |ui, percent| {
            let slider = slid(ui, percent, 0.0..=100.0, &[("%", 1.0)]);
            ui.add_enabled(obstacle.is_none(), slider.suffix(" %").fixed_decimals(0))
        });
        let slider = slider.labelled_by(label.id);
        let slider = slider
            .on_hover_text(
                "Shows and saves a share of the edit: every handle moves and turns by this share. The next move \
                 starts from the visible shape.",
            )
            .on_disabled_hover_text(obstacle.as_deref().unwrap_or_default());
        commands.adjust(&slider, || Command::SetStrength(percent / 100.0));
        let is_sequence = editor.document().animation().frames().is_some();
        if editor.view().look.timeline
            && !is_sequence
            && icon_choice(ui, editor, &Command::KeyStrength, false, Glyph::DiamondPlus, None)
        {
            commands.push(Command::KeyStrength);
        }
    });
}
