//! The window's colours and spacing: a neutral frame, dark or light, so that the surface stands out.

use eframe::egui::{self, Color32, CornerRadius, Stroke, Theme, ThemePreference, Visuals};

use crate::window::files::settings::{Settings, ThemeChoice};

/// The accent colour: for the selected handle and the active tool.
pub const ACCENT: Color32 = Color32::from_rgb(226, 172, 72);

/// Dresses the context as the settings say.
pub fn apply(context: &egui::Context, settings: &Settings) {
    context.set_visuals_of(Theme::Dark, dark());
    context.set_visuals_of(Theme::Light, light());
    context.set_theme(match settings.theme {
        ThemeChoice::Dark => ThemePreference::Dark,
        ThemeChoice::Light => ThemePreference::Light,
        ThemeChoice::System => ThemePreference::System,
    });
    context.set_zoom_factor(settings.ui_scale);
    context.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(8.0, 6.0);
        style.spacing.button_padding = egui::vec2(9.0, 4.0);
        style.spacing.slider_width = 120.0;
        // Scroll bars float, and would cover what is at the right edge.
        style.spacing.scroll.floating_allocated_width = style.spacing.scroll.bar_width;
        style
            .text_styles
            .insert(egui::TextStyle::Small, egui::FontId::proportional(11.0));
    });
}

fn dark() -> Visuals {
    let mut visuals = Visuals::dark();
    visuals.panel_fill = Color32::from_rgb(43, 45, 49);
    visuals.window_fill = Color32::from_rgb(50, 52, 57);
    visuals.extreme_bg_color = Color32::from_rgb(30, 32, 35);
    visuals.selection.bg_fill = Color32::from_rgb(122, 92, 38);
    visuals.selection.stroke = Stroke::new(1.0, Color32::from_rgb(255, 226, 164));
    visuals.hyperlink_color = ACCENT;
    visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(208);
    visuals.widgets.inactive.fg_stroke.color = Color32::from_gray(218);
    rounded(visuals)
}

fn light() -> Visuals {
    let mut visuals = Visuals::light();
    visuals.panel_fill = Color32::from_rgb(236, 236, 238);
    visuals.window_fill = Color32::from_rgb(246, 246, 247);
    visuals.extreme_bg_color = Color32::WHITE;
    visuals.selection.bg_fill = Color32::from_rgb(244, 214, 150);
    visuals.selection.stroke = Stroke::new(1.0, Color32::from_rgb(92, 62, 8));
    visuals.hyperlink_color = Color32::from_rgb(158, 104, 10);
    visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(40);
    visuals.widgets.inactive.fg_stroke.color = Color32::from_gray(30);
    rounded(visuals)
}

fn rounded(mut visuals: Visuals) -> Visuals {
    visuals.window_corner_radius = CornerRadius::same(8);
    for widget in [
        &mut visuals.widgets.inactive,
        &mut visuals.widgets.hovered,
        &mut visuals.widgets.active,
    ] {
        widget.corner_radius = CornerRadius::same(5);
    }
    visuals
}
