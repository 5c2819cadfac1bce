//! The stiffness of discrete shells as one slider, from paper to rubber: their option `bending` on a logarithmic scale.

use eframe::egui::{self, Slider};
use pliant_deform::{OptionValue, Shells};
use pliant_editor::{Command, Editor};

use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::row_label::row_label;

/// Shows the slider, where the method is discrete shells.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let method = editor.document().method();
    let Some(shells) = method.options::<Shells>() else {
        return;
    };
    let [paper, rubber] = Shells::PAPER_TO_RUBBER;
    let mut bending = shells.bending;
    ui.horizontal(|ui| {
        let label = row_label(ui, "Paper");
        let slider = Slider::new(&mut bending, paper..=rubber)
            .logarithmic(true)
            .show_value(false);
        let slider = ui.add(slider).labelled_by(label.id).on_hover_text(
            "Paper keeps its lengths and creases; thick rubber bends evenly and stretches instead. It sets `bending`.",
        );
        ui.label("rubber");
        commands.adjust(&slider, || {
            let set = method.with([("bending", OptionValue::Number(bending))]);
            Command::SetMethod(set.unwrap_or_else(|_| method.clone()))
        });
    });
}
