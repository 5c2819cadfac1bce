//! The limits of the joint of a chain or of a limb's part in numbers.

use eframe::egui;
use pliant_editor::{Command, Editor, FREE_BEND_DEG};

use crate::window::widgets::number_field::{DEGREES, dragged, number_field};
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::row_label::row_label;

const HOVERS: [&str; 2] = [
    "Sets the least bend of this joint while Chain or Whole limb pulls: a knee that is never straight does not bend the \
     wrong way.",
    "Sets the most bend of this joint while Chain or Whole limb pulls: 0° is straight.",
];

/// Shows the least and the most bend at the selected points of the handle's curve, or at the joint of a limb's part.
pub(super) fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let Some(range_deg) = editor.selected_bend_deg() else {
        return;
    };
    let label = row_label(ui, "Bend");
    ui.horizontal(|ui| {
        ui.spacing_mut().interact_size.x = 54.0;
        for (place, hover) in HOVERS.into_iter().enumerate() {
            let mut changed = range_deg;
            let field = number_field(ui, &mut changed[place], |ui, value| {
                let field = dragged(ui, value, DEGREES).range(FREE_BEND_DEG[0]..=FREE_BEND_DEG[1]);
                ui.add(field.speed(0.5).max_decimals(1).suffix("°"))
            });
            let field = field.labelled_by(label.id).on_hover_text(hover);
            // The other end makes room.
            changed[1 - place] = match place {
                0 => changed[1].max(changed[0]),
                _ => changed[0].min(changed[1]),
            };
            commands.adjust(&field, || Command::SetBendRange(changed));
        }
    });
    ui.end_row();
}
