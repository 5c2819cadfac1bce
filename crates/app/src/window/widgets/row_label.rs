//! The name before a field, on the field's own height: one column for all rows of the panel, and as wide as it is in a
//! bar.

use eframe::egui::{self, Align, Label, Layout, TextStyle};

/// The column's least width; longer names are wider.
const WIDTH: f32 = 70.0;

/// The width beside a name in a bar, in points, that the widest field needs.
const FIELD: f32 = 140.0;

/// Shows the name in the panel.
pub fn row_label(ui: &mut egui::Ui, name: impl Into<egui::WidgetText>) -> egui::Response {
    label(ui, name, WIDTH)
}

/// Shows the name in a bar, on the next line of it if its field does not fit beside it on this one.
pub fn bar_label(ui: &mut egui::Ui, name: &str) -> egui::Response {
    let is_first = ui.cursor().left() <= ui.max_rect().left();
    if ui.layout().main_wrap() && !is_first {
        let galley = egui::WidgetText::from(name).into_galley(
            ui,
            Some(egui::TextWrapMode::Extend),
            f32::INFINITY,
            TextStyle::Body,
        );
        let needed = galley.size().x + ui.spacing().item_spacing.x + FIELD;
        if ui.available_size_before_wrap().x < needed {
            ui.end_row();
        }
    }
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
