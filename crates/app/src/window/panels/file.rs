//! Information about the open file; each fault found in its mesh leads to its place.

use eframe::egui::{self, RichText};
use pliant_editor::{Command, Editor, thousands};
use pliant_mesh::{FindingKind, Model, Named};

use super::notes::Notes;
use super::weld;
use crate::window::widgets::command_button::command_button;
use crate::window::widgets::outbox::Outbox;

/// Shows the file's numbers, notes and findings.
pub fn show(ui: &mut egui::Ui, editor: &Editor, notes: &Notes, commands: &mut Outbox) {
    let Some(model) = editor.view().model else {
        ui.label(RichText::new("Nothing is open.").weak());
        return;
    };
    ui.label(format!(
        "{} vertices, {} triangles",
        thousands(model.drawn.file_vertex_count()),
        thousands(model.surface.triangles.len())
    ));
    weld::show(ui, editor, model, commands);
    for kind in FindingKind::ALL {
        if let Some(sentence) = model.findings.sentence(kind) {
            finding(ui, model, kind, &sentence, commands);
            if kind == FindingKind::InsideOutComponents {
                turn(ui, editor, model, commands);
            }
            if kind == FindingKind::LooseBits && command_button(ui, editor, &Command::ToggleSmallShown) {
                commands.push(Command::ToggleSmallShown);
            }
        }
    }
    for note in &notes.about_file {
        ui.add(egui::Label::new(RichText::new(note).weak().small()).wrap());
    }
    places(ui, "borders that stay open", &notes.open_borders, commands);
}

/// Shows the state of inward-facing parts, and the button that turns them.
fn turn(ui: &mut egui::Ui, editor: &Editor, model: &Model, commands: &mut Outbox) {
    ui.horizontal_wrapped(|ui| {
        let turned = editor.document().inside_out();
        if model.inside_out.iter().all(|part| turned.contains(part)) {
            ui.label(
                RichText::new("All inward-facing parts are turned: they are saved facing outwards.")
                    .weak()
                    .small(),
            );
        }
        if command_button(ui, editor, &Command::TurnInsideOut) {
            commands.push(Command::TurnInsideOut);
        }
    });
}

/// A sentence, and a button for each of its examples.
fn finding(ui: &mut egui::Ui, model: &Model, kind: FindingKind, sentence: &str, commands: &mut Outbox) {
    ui.add(egui::Label::new(RichText::new(sentence).weak().small()).wrap());
    let places: Vec<u32> = model
        .findings
        .of(kind)
        .examples
        .iter()
        .filter_map(|&number| match kind.named() {
            Named::FileVertex => Some(number),
            Named::DrawnTriangle => {
                let [corner, ..] = model.drawn_triangle(number)?;
                Some(model.drawn.file_vertex(corner).0)
            }
        })
        .collect();
    self::places(ui, sentence, &places, commands);
}

/// A button for each of these vertices, numbered as in the file.
fn places(ui: &mut egui::Ui, of: &str, vertices: &[u32], commands: &mut Outbox) {
    if vertices.is_empty() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        ui.label(RichText::new("Show").weak().small());
        for (number, &vertex) in vertices.iter().enumerate() {
            let button = ui.small_button((number + 1).to_string());
            let label = format!("Show place {} of: {of}", number + 1);
            button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            if button
                .on_hover_text(format!("Moves the view to vertex {vertex}."))
                .clicked()
            {
                commands.push(Command::FrameFileVertex(vertex));
            }
        }
    });
}
