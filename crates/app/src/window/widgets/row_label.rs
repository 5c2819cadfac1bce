//! The name before a field: one column for all rows of the panel, on the field's own height.

use eframe::egui::{self, Align, Label, Layout, TextStyle};

/// The column's least width; longer names are wider.
const WIDTH: f32 = 70.0;

/// Shows the name.
pub fn row_label(ui: &mut egui::Ui, name: impl Into<egui::WidgetText>) -> egui::Response {
    let height = ui.text_style_height(&TextStyle::Button) + 2.0 * ui.spacing().button_padding.y;
    let size = egui::vec2(WIDTH, height);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_size(size);
        ui.add(Label::new(name).extend())
    })
    .inner
}
