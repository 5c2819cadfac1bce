//! The legend of painted stiffness, over the view.

use eframe::egui::{self, Color32};
use pliant_editor::stiffness_colour;

/// Paints the meaning of the colours, from 0.001 to 1000 and rigid, with its upper left corner at `corner`.
pub fn paint(ui: &egui::Ui, corner: egui::Pos2) {
    const SIZE: egui::Vec2 = egui::vec2(190.0, 24.0);
    const RIGID: f32 = 24.0;
    const BAR: f32 = 9.0;
    const STEPS: usize = 60;
    let rect = egui::Rect::from_min_size(corner, SIZE);
    let painter = ui.painter();
    painter.rect_filled(rect.expand(6.0), 4.0, ui.visuals().panel_fill.gamma_multiply(0.85));
    let width = SIZE.x - RIGID - 16.0;
    let bar = rect.top()..=rect.top() + BAR;
    for step in 0..STEPS {
        let [from, to] = [step, step + 1].map(|step| rect.left() + width * step as f32 / STEPS as f32);
        let decades = 6.0 * (step as f64 + 0.5) / STEPS as f64 - 3.0;
        let [red, green, blue, _] = stiffness_colour(10_f64.powf(decades));
        let piece = egui::Rect::from_x_y_ranges(from..=to + 0.5, bar.clone());
        painter.rect_filled(piece, 0.0, Color32::from_rgb(red, green, blue));
    }
    let [red, green, blue, _] = stiffness_colour(f64::INFINITY);
    let rigid = egui::Rect::from_x_y_ranges(rect.right() - RIGID..=rect.right(), bar);
    painter.rect_filled(rigid, 0.0, Color32::from_rgb(red, green, blue));
    let font = egui::TextStyle::Small.resolve(ui.style());
    let colour = ui.visuals().weak_text_color();
    for (x, text, align) in [
        (rect.left(), "0.001", egui::Align2::LEFT_TOP),
        (rect.left() + 0.5 * width, "1", egui::Align2::CENTER_TOP),
        (rect.left() + width, "1000", egui::Align2::RIGHT_TOP),
        (rigid.center().x, "rigid", egui::Align2::CENTER_TOP),
    ] {
        let at = egui::pos2(x, rect.top() + BAR + 2.0);
        painter.text(at, align, text, font.clone(), colour);
    }
}
