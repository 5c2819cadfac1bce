//! The choice for loose parts: for all of them, and for each.

use eframe::egui::{self, ComboBox, RichText, ScrollArea};
use pliant_deform::Loose;
use pliant_editor::{Command, Editor, thousands};
use pliant_mesh::Model;

use super::part_name::part_name;
use crate::window::widgets::command_button::choices;
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::row_label::row_label;

const CHOICES: [(Loose, &str, &str); 3] = [
    (
        Loose::Follow,
        "follow",
        "Loose parts keep their shape and follow the surface beside them, like eyes or buttons.",
    ),
    (
        Loose::Bend,
        "bend along",
        "Each point follows the surface beside it, like straps, seams or bandages.",
    ),
    (Loose::Rest, "rest", "Loose parts stay in place."),
];

/// Shows the choice for all parts and the list of those that are loose.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let document = editor.document();
    ui.horizontal_wrapped(|ui| {
        row_label(ui, "Loose parts")
            .on_hover_text("Loose parts of the surface have neither a handle nor a fixed vertex.");
        if let Some(loose) = choices(ui, document.loose(), &CHOICES) {
            commands.push(Command::SetLoose(loose));
        }
    });
    let (Some(model), parts) = (editor.view().model, editor.loose_components()) else {
        return;
    };
    if parts.is_empty() {
        light(editor, None, commands);
        return;
    }
    let title = format!(
        "{} loose {}",
        parts.len(),
        if parts.len() == 1 { "part" } else { "parts" }
    );
    let mut pointed = None;
    egui::CollapsingHeader::new(RichText::new(title).small())
        .id_salt("loose parts")
        .show(ui, |ui| {
            let height = ui.spacing().interact_size.y;
            ScrollArea::vertical()
                .id_salt("loose")
                .max_height(160.0)
                .auto_shrink([false, true])
                .show_rows(ui, height, parts.len(), |ui, seen| {
                    for number in seen {
                        if row(ui, editor, model, parts[number], commands) {
                            pointed = Some(parts[number]);
                        }
                    }
                });
        });
    light(editor, pointed, commands);
}

/// Highlights the part whose row is under the pointer.
fn light(editor: &Editor, part: Option<u32>, commands: &mut Outbox) {
    if editor.lit_part() != part {
        commands.push(Command::LightPart(part));
    }
}

/// A part's row; whether the pointer is on it.
fn row(ui: &mut egui::Ui, editor: &Editor, model: &Model, part: u32, commands: &mut Outbox) -> bool {
    let Some(component) = model.topology.components().get(part as usize) else {
        return false;
    };
    let own = editor.document().loose_parts().get(&part).copied();
    let row = ui.horizontal(|ui| {
        let name = part_name(model, part, editor.view().camera.up);
        let hover = format!(
            "Moves the view to this part of {} vertices.",
            thousands(component.vertex_count)
        );
        let label = ui.button(name).on_hover_text(hover);
        if label.clicked() {
            commands.push(Command::FramePart(part));
        }
        let name_of = |loose: Option<Loose>| {
            let named = CHOICES.iter().find(|(choice, ..)| Some(*choice) == loose);
            named.map_or("as set above", |(_, name, _)| *name)
        };
        let list = ComboBox::from_id_salt(("loose part", part))
            .selected_text(name_of(own))
            .width(90.0)
            .show_ui(ui, |ui| {
                let choices = CHOICES.iter().map(|(loose, _, hover)| (Some(*loose), *hover));
                for (loose, hover) in std::iter::once((None, "Uses the choice for all loose parts.")).chain(choices) {
                    let choice = ui.selectable_label(own == loose, name_of(loose)).on_hover_text(hover);
                    if choice.clicked() && own != loose {
                        commands.push(Command::SetLoosePart(part, loose));
                    }
                }
            });
        list.response.labelled_by(label.id);
    });
    row.response.contains_pointer()
}
