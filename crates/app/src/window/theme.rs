//! The window's colours and spacing: a dim, neutral frame that leaves the eye to the surface.

use eframe::egui::{self, Color32, CornerRadius, Stroke, Visuals};

/// What the program asks the eye to notice: the selected handle, the active tool.
pub const ACCENT: Color32 = Color32::from_rgb(226, 172, 72);
/// Bars and panels.
const PANEL: Color32 = Color32::from_rgb(43, 45, 49);
/// Fields one types into.
const FIELD: Color32 = Color32::from_rgb(30, 32, 35);

/// Dresses the context.
pub fn apply(context: &egui::Context) {
    let mut visuals = Visuals::dark();
    visuals.panel_fill = PANEL;
    visuals.window_fill = Color32::from_rgb(50, 52, 57);
    visuals.extreme_bg_color = FIELD;
    visuals.selection.bg_fill = Color32::from_rgb(122, 92, 38);
    visuals.selection.stroke = Stroke::new(1.0, Color32::from_rgb(255, 226, 164));
    visuals.hyperlink_color = ACCENT;
    visuals.window_corner_radius = CornerRadius::same(8);
    visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(208);
    visuals.widgets.inactive.fg_stroke.color = Color32::from_gray(218);
    for widget in [
        &mut visuals.widgets.inactive,
        &mut visuals.widgets.hovered,
        &mut visuals.widgets.active,
    ] {
        widget.corner_radius = CornerRadius::same(5);
    }
    context.set_theme(egui::Theme::Dark);
    context.set_visuals(visuals);
    context.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(8.0, 6.0);
        style.spacing.button_padding = egui::vec2(9.0, 4.0);
        style.spacing.slider_width = 120.0;
    });
}
