//! Warnings about damage: the places where bending has put the surface through itself, with a button for each, and the
//! damaged triangles and edges.

use eframe::egui::{self, RichText};
use pliant_editor::{Command, Editor};

use crate::window::widgets::outbox::Outbox;

/// The number of places that have a button: the largest ones.
const SHOWN: usize = 8;

/// Shows the sentences about the faults, and the buttons.
pub fn show(ui: &mut egui::Ui, editor: &Editor, faults: &[String], commands: &mut Outbox) {
    let Some(found) = editor.intersections() else { return };
    let colour = ui.visuals().warn_fg_color;
    for sentence in faults {
        ui.add(egui::Label::new(RichText::new(sentence).small().color(colour)).wrap());
    }
    if found.is_empty() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        for place in 0..found.places.len().min(SHOWN) {
            let label = match found.places.len() {
                1 => "Go there".to_owned(),
                _ => format!("Go to {}", place + 1),
            };
            let hover = "Moves the view to this place. The surface passes through itself along the red lines.";
            if ui.small_button(label).on_hover_text(hover).clicked() {
                commands.push(Command::FrameIntersection(place));
            }
        }
    });
}
