//! The name before a field in a bar, on the field's own height.

use eframe::egui::{self, Align, Label, Layout, TextStyle};

/// Shows the name.
pub fn name_before(ui: &mut egui::Ui, name: &str) -> egui::Response {
    let height = ui.text_style_height(&TextStyle::Button) + 2.0 * ui.spacing().button_padding.y;
    ui.allocate_ui_with_layout(egui::vec2(0.0, height), Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_height(height);
        ui.add(Label::new(name).extend())
    })
    .inner
}
