//! The panel beside the view: handles, brush, how the surface bends, what was done, and what is to be known about the
//! file.

use eframe::egui::{self, RichText, ScrollArea};
use pliant_deform::Loose;
use pliant_editor::{Command, Editor};

use super::command_button::command_button;
use super::notes::Notes;
use super::outbox::Outbox;
use super::{brush_panel, file_panel, handles_panel, history_panel, method_panel};

/// Shows the panel; commands for the editor are added to `commands`.
pub fn show(ui: &mut egui::Ui, editor: &Editor, notes: &Notes, commands: &mut Outbox) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.add_space(4.0);
        section(ui, "Handles", |ui| handles_panel::show(ui, editor, commands));
        section(ui, "Brush", |ui| brush_panel::show(ui, editor, commands));
        section(ui, "Bending", |ui| bending(ui, editor, commands));
        section(ui, "History", |ui| history_panel::show(ui, editor, commands));
        section(ui, "File", |ui| file_panel::show(ui, editor, notes, commands));
    });
}

/// A part of the panel that can be folded away; which ones are is remembered while the window is open.
fn section(ui: &mut egui::Ui, title: &str, contents: impl FnOnce(&mut egui::Ui)) {
    egui::CollapsingHeader::new(RichText::new(title).strong().size(14.0))
        .id_salt(title)
        .default_open(true)
        .show_unindented(ui, |ui| {
            ui.add_space(2.0);
            contents(ui);
        });
    ui.add_space(2.0);
    ui.separator();
}

fn bending(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    method_panel::show(ui, editor, commands);
    let document = editor.document();
    ui.horizontal(|ui| {
        ui.label("Loose parts");
        for (name, loose, hover) in [
            (
                "follow",
                Loose::Follow,
                "Parts that nothing holds move along with the surface beside them.",
            ),
            ("rest", Loose::Rest, "Parts that nothing holds stay where they are."),
        ] {
            if ui
                .selectable_label(document.loose() == loose, name)
                .on_hover_text(hover)
                .clicked()
            {
                commands.push(Command::SetLoose(loose));
            }
        }
    });
    ui.horizontal_wrapped(|ui| {
        for command in [Command::Apply, Command::ResetShape, Command::ClearRegions] {
            if command_button(ui, editor, &command) {
                commands.push(command);
            }
        }
    });
}
