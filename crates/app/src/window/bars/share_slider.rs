//! A slider of a tool's setting that is a share.

use eframe::egui;

use crate::window::widgets::number_field::{number_field, slid};
use crate::window::widgets::row_label::bar_label;

/// A share from 0 to 1.
pub fn share(ui: &mut egui::Ui, name: &str, value: &mut f64, hover: &str) {
    let label = bar_label(ui, name);
    let slider = number_field(ui, value, |ui, value| {
        let slider = slid(ui, value, 0.0..=1.0, &[]).fixed_decimals(2);
        ui.add(slider)
    });
    slider.labelled_by(label.id).on_hover_text(hover);
}
