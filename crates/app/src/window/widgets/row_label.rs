//! The name before a field, on the field's own height: one column for all rows of the panel, and as wide as it is in a
//! bar.

use eframe::egui::{self, Align, Label, Layout, TextStyle};

/// The column's least width; longer names are wider.
const WIDTH: f32 = 70.0;

/// Shows the name in the panel.
pub fn row_label(ui: &mut egui::Ui, name: impl Into<egui::WidgetText>) -> egui::Response {
    label(ui, name, WIDTH)
}

/// Shows the name in a bar.
pub fn bar_label(ui: &mut egui::Ui, name: impl Into<egui::WidgetText>) -> egui::Response {
    label(ui, name, 0.0)
}

fn label(ui: &mut egui::Ui, name: impl Into<egui::WidgetText>, width: f32) -> egui::Response {
    let height = ui.text_style_height(&TextStyle::Button) + 2.0 * ui.spacing().button_padding.y;
    let size = egui::vec2(width, height);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_size(size);
        ui.add(Label::new(name).extend())
    })
    .inner
}
