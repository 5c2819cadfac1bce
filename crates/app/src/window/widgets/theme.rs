//! The window's colours and spacing: a neutral frame, dark or light, so that the surface stands out.

use eframe::egui::{self, Color32, CornerRadius, Stroke, Theme, ThemePreference, Visuals};

use crate::window::files::settings::{Settings, ThemeChoice};

/// The accent colour: for the selected handle and the active tool.
pub const ACCENT: Color32 = Color32::from_rgb(226, 172, 72);

/// Gives the context the look in the settings.
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
        // Lists are as high as their content, instead of 400.
        style.spacing.default_area_size.y = 720.0;
        // Scroll bars float, and would cover the content at the right edge.
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
    visuals.weak_text_color = Some(Color32::from_gray(166));
    visuals.widgets.hovered.weak_bg_fill = Color32::from_gray(58);
    rounded(visuals)
}

fn light() -> Visuals {
    let mut visuals = Visuals::light();
    visuals.panel_fill = Color32::from_rgb(236, 236, 238);
    visuals.window_fill = Color32::from_rgb(246, 246, 247);
    visuals.extreme_bg_color = Color32::WHITE;
    visuals.selection.bg_fill = Color32::from_rgb(244, 214, 150);
    visuals.selection.stroke = Stroke::new(1.0, Color32::from_rgb(92, 62, 8));
    visuals.hyperlink_color = Color32::from_rgb(140, 90, 6);
    visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(40);
    visuals.widgets.inactive.fg_stroke.color = Color32::from_gray(30);
    visuals.weak_text_color = Some(Color32::from_gray(82));
    visuals.warn_fg_color = Color32::from_rgb(150, 70, 0);
    visuals.widgets.active.weak_bg_fill = Color32::from_gray(202);
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

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};
    use pliant_editor::{Camera, UpAxis};
    use pliant_render::Background;

    use super::*;
    use crate::window::bars::status;
    use crate::window::viewport::backdrop::Backdrop;
    use pliant_picture::drawing::ground;

    /// The least contrast of text, by the Web Content Accessibility Guidelines 2.2 (1.4.3).
    const LEAST: f64 = 4.5;

    /// Relative luminance as those guidelines define it.
    fn luminance(colour: Color32) -> f64 {
        let [red, green, blue] = [colour.r(), colour.g(), colour.b()].map(|byte| {
            let share = f64::from(byte) / 255.0;
            match share <= 0.04045 {
                true => share / 12.92,
                false => ((share + 0.055) / 1.055).powf(2.4),
            }
        });
        0.2126 * red + 0.7152 * green + 0.0722 * blue
    }

    fn contrast(text: Color32, ground: Color32) -> f64 {
        // Translucent colours are blended as in egui, in gamma space.
        let share = 1.0 - f32::from(text.a()) / 255.0;
        let [red, green, blue] = [(text.r(), ground.r()), (text.g(), ground.g()), (text.b(), ground.b())]
            .map(|(text, ground)| (f32::from(text) + share * f32::from(ground)).round() as u8);
        let [text, ground] = [Color32::from_rgb(red, green, blue), ground].map(luminance);
        (text.max(ground) + 0.05) / (text.min(ground) + 0.05)
    }

    /// Every colour of text and signs with every background that it may have, each with its name. Disabled widgets are
    /// excepted, as in the guidelines: they are faded on purpose.
    fn pairs(ui: &egui::Ui) -> Vec<(String, Color32, Color32)> {
        let visuals = ui.visuals();
        let widgets = &visuals.widgets;
        let frames = [("panels", visuals.panel_fill), ("windows", visuals.window_fill)];
        let of_buttons = [
            ("buttons", &widgets.inactive),
            ("buttons under the pointer", &widgets.hovered),
            ("pressed buttons", &widgets.active),
            ("open menus", &widgets.open),
        ];
        let buttons = of_buttons.map(|(name, own)| (name, own.weak_bg_fill));
        let fields = [("fields", visuals.text_edit_bg_color())];
        let selected = [("what is selected", visuals.selection.bg_fill)];
        let mut pairs = Vec::new();
        let mut add = |name: &str, text: Color32, grounds: &[(&str, Color32)]| {
            pairs.extend(
                grounds
                    .iter()
                    .map(|(of, ground)| (format!("{name} on {of}"), text, *ground)),
            );
        };
        let everywhere = [&frames[..], &buttons, &fields].concat();
        add("text", visuals.text_color(), &[&frames[..], &fields].concat());
        add(
            "strong text",
            visuals.strong_text_color(),
            &[&frames[..], &buttons].concat(),
        );
        // Shortcuts appear on buttons, hints in fields.
        add("weak text", visuals.weak_text_color(), &everywhere);
        for (name, own) in of_buttons {
            // Buttons without a frame, signs of check boxes and folded sections, too.
            add(
                name,
                own.text_color(),
                &[&frames[..], &[("their own", own.weak_bg_fill), ("boxes", own.bg_fill)]].concat(),
            );
        }
        if let Background::Gradient { top, bottom } = Backdrop::of(visuals).background() {
            let [top, bottom] = [top, bottom].map(|[r, g, b]| Color32::from_rgb(r, g, b));
            let view = [("the view's top", top), ("the view's bottom", bottom)];
            add("text", visuals.text_color(), &view);
        }
        add("text of what is selected", visuals.selection.stroke.color, &selected);
        for (name, text) in [
            ("links and headings of hints", visuals.hyperlink_color),
            ("warnings", visuals.warn_fg_color),
            ("what went wrong", status::failed(ui)),
            ("what went well", status::done(ui)),
        ] {
            add(name, text, &frames);
        }
        pairs
    }

    #[test]
    fn text_and_signs_stand_out_from_what_they_lie_on_in_both_themes() {
        for (theme, visuals) in [("dark", dark()), ("light", light())] {
            egui::__run_test_ui(|ui| {
                *ui.visuals_mut() = visuals.clone();
                let pairs = pairs(ui);
                assert!(pairs.len() > 40);
                let poor: Vec<String> = pairs
                    .into_iter()
                    .map(|(name, text, ground)| (name, contrast(text, ground)))
                    .filter(|(_, contrast)| *contrast < LEAST)
                    .map(|(name, contrast)| format!("{name}: {contrast:.2}"))
                    .collect();
                assert!(poor.is_empty(), "{theme}: {poor:#?}");
            });
        }
    }

    /// The least contrast of graphics that a person must recognise, by the same guidelines (1.4.11).
    const LEAST_OF_GRAPHICS: f64 = 3.0;

    #[test]
    fn the_axes_on_the_ground_stand_out_from_the_pale_view() {
        let Background::Gradient { top, bottom } = Backdrop::Light.background() else {
            unreachable!("the pale view is a gradient");
        };
        for up in [UpAxis::Y, UpAxis::Z] {
            let camera = Camera {
                up,
                ..Camera::default()
            };
            let grid = Backdrop::Light.grid(ground(&camera, DVec2::new(800.0, 600.0), 0.0, DVec3::ZERO));
            for [red, green, blue, alpha] in grid.axis_colours {
                let axis = Color32::from_rgba_unmultiplied(red, green, blue, alpha);
                for [red, green, blue] in [top, bottom] {
                    let contrast = contrast(axis, Color32::from_rgb(red, green, blue));
                    assert!(contrast > LEAST_OF_GRAPHICS, "{axis:?}: {contrast:.2}");
                }
            }
        }
    }

    #[test]
    fn contrast_is_that_of_the_guidelines() {
        assert!((contrast(Color32::BLACK, Color32::WHITE) - 21.0).abs() < 1e-9);
        assert!((contrast(Color32::from_gray(119), Color32::WHITE) - 4.478).abs() < 1e-3);
    }
}
