//! The sharpness and the width of a crease in numbers.

use eframe::egui;
use pliant_editor::{Command, Editor, SHARPEN_RANGE};

use crate::window::widgets::number_field::{LENGTHS, dragged, number_field, slid};
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::row_label::row_label;

/// Shows how sharp and how wide the crease along the handle's curve is, if it has one.
pub(super) fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let Some(crease) = editor.selected_crease() else {
        return;
    };
    let label = row_label(ui, "Sharpen");
    let mut sharpen = crease.sharpen();
    let field = number_field(ui, &mut sharpen, |ui, value| {
        ui.add(slid(ui, value, SHARPEN_RANGE, &[]).fixed_decimals(2))
    });
    let field = field.labelled_by(label.id).on_hover_text(
        "Makes the crease sharper than at rest, or flatter: -1 is flat, 0 as it was and 1 twice as sharp.",
    );
    commands.adjust(&field, || Command::SharpenCrease(sharpen));
    ui.end_row();
    let label = row_label(ui, "Crease width");
    let mut width = crease.width();
    let speed = 0.02 * width;
    let field = number_field(ui, &mut width, |ui, value| {
        let field = dragged(ui, value, LENGTHS).range(0.0..=f64::MAX).speed(speed);
        ui.add(field.max_decimals(4))
    });
    let field = field
        .labelled_by(label.id)
        .on_hover_text("Sets the distance from the crease up to which the surface gets sharper or flatter.");
    commands.adjust(&field, || Command::SetCreaseWidth(width));
    ui.end_row();
    if editor.is_crease_narrow() {
        ui.label("");
        let note = "Narrower than the edges here: only the line itself moves.";
        ui.add(egui::Label::new(egui::RichText::new(note).weak().small()).wrap());
        ui.end_row();
    }
}
