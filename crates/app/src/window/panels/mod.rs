//! The panel beside the view: handles, brush, the bending of the surface, the history, and information about the file.

pub(in crate::window) mod brush;
mod examples;
pub(in crate::window) mod file;
pub(in crate::window) mod handles;
pub(in crate::window) mod history;
mod intersections;
pub(in crate::window) mod loose;
mod material;
pub(in crate::window) mod method;
mod method_picture;
pub(in crate::window) mod notes;
pub(in crate::window) mod objects;
mod part_name;
mod poses;
mod strength;
mod title;
mod weld;

use std::collections::BTreeSet;

use eframe::egui;
use eframe::egui::ScrollArea;
use pliant_editor::{Command, Editor};

use crate::window::widgets::command_button::command_button;
use crate::window::widgets::outbox::Outbox;
use notes::Notes;

/// Shows the panel; commands for the editor are added to `commands`. The title of a section that was folded away or
/// unfolded is returned.
pub fn show(
    ui: &mut egui::Ui,
    editor: &Editor,
    notes: &Notes,
    morph_targets: &[String],
    folded: &BTreeSet<String>,
    commands: &mut Outbox,
) -> Option<&'static str> {
    let mut turned = None;
    let mut section = |ui: &mut egui::Ui, title, contents: &mut dyn FnMut(&mut egui::Ui)| {
        if section(ui, title, folded, contents) {
            turned = Some(title);
        }
    };
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.add_space(4.0);
        section(ui, "Handles", &mut |ui| handles::show(ui, editor, commands));
        if editor.document().poses().is_empty() {
            poses::show_none(ui, editor, commands);
        } else {
            section(ui, "Poses", &mut |ui| poses::show(ui, editor, commands));
        }
        section(ui, "Objects", &mut |ui| objects::show(ui, editor, commands));
        section(ui, "Brush", &mut |ui| brush::show(ui, editor, commands));
        section(ui, "Bending", &mut |ui| bending(ui, editor, morph_targets, commands));
        section(ui, "History", &mut |ui| history::show(ui, editor, commands));
        section(ui, "File", &mut |ui| file::show(ui, editor, notes, commands));
    });
    turned
}

/// A part of the panel that can be folded; true if it was folded or unfolded just now.
fn section(ui: &mut egui::Ui, title: &str, folded: &BTreeSet<String>, contents: &mut dyn FnMut(&mut egui::Ui)) -> bool {
    let header = egui::CollapsingHeader::new(title::title(title))
        .id_salt(title)
        .default_open(!folded.contains(title))
        .show_unindented(ui, |ui| {
            ui.add_space(2.0);
            contents(ui);
        });
    ui.add_space(2.0);
    ui.separator();
    header.header_response.clicked()
}

fn bending(ui: &mut egui::Ui, editor: &Editor, morph_targets: &[String], commands: &mut Outbox) {
    method::show(ui, editor, morph_targets, commands);
    loose::show(ui, editor, commands);
    strength::show(ui, editor, commands);
    intersections::show(ui, editor, commands);
    ui.horizontal_wrapped(|ui| {
        for command in [Command::Apply, Command::ResetShape, Command::ClearRegions] {
            if command_button(ui, editor, &command) {
                commands.push(command);
            }
        }
    });
}
