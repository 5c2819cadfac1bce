//! Small toggles that are drawn rather than written: the window's font has no signs for them.

use eframe::egui::{self, Color32, Painter, Pos2, Rect, Sense, Stroke};

/// What is drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Icon {
    /// An eye, crossed out while off.
    Eye,
    /// A padlock, open while off.
    Lock,
    /// A ring, with a dot in it while on.
    Alone,
}

/// A toggle with a name for screen readers; true when it is clicked.
pub fn toggle(ui: &mut egui::Ui, icon: Icon, is_on: bool, name: &str, hover: &str) -> bool {
    let (rect, response) = ui.allocate_exact_size(egui::vec2(18.0, 18.0), Sense::click());
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, is_on, name));
    let visuals = ui.visuals();
    let colour = match (response.hovered(), is_on) {
        (true, _) => visuals.strong_text_color(),
        (false, true) => visuals.text_color(),
        (false, false) => visuals.weak_text_color().gamma_multiply(0.7),
    };
    match icon {
        Icon::Eye => eye(ui.painter(), rect, colour, is_on),
        Icon::Lock => lock(ui.painter(), rect, colour, is_on),
        Icon::Alone => alone(ui.painter(), rect, colour, is_on),
    }
    response.on_hover_text(hover).clicked()
}

fn eye(painter: &Painter, rect: Rect, colour: Color32, is_open: bool) {
    let stroke = Stroke::new(1.2, colour);
    let centre = rect.center();
    let lid = |up: f32| -> Vec<Pos2> {
        (0..=10)
            .map(|step| {
                let x = step as f32 / 5.0 - 1.0;
                centre + egui::vec2(6.5 * x, up * 4.0 * (1.0 - x * x))
            })
            .collect()
    };
    painter.line(lid(-1.0), stroke);
    painter.line(lid(1.0), stroke);
    if is_open {
        painter.circle_filled(centre, 1.9, colour);
    } else {
        painter.line_segment([centre + egui::vec2(-5.0, 5.0), centre + egui::vec2(5.0, -5.0)], stroke);
    }
}

fn lock(painter: &Painter, rect: Rect, colour: Color32, is_closed: bool) {
    let centre = rect.center() + egui::vec2(0.0, 2.0);
    let body = Rect::from_center_size(centre + egui::vec2(0.0, 1.5), egui::vec2(9.0, 6.5));
    let shift = if is_closed { 0.0 } else { 3.0 };
    let arch: Vec<Pos2> = (0..=8)
        .map(|step| {
            let angle = std::f32::consts::PI * (1.0 + step as f32 / 8.0);
            centre + egui::vec2(shift + 2.8 * angle.cos(), -3.0 + 3.2 * angle.sin())
        })
        .collect();
    let stroke = Stroke::new(1.3, colour);
    painter.line_segment([arch[0], egui::pos2(arch[0].x, body.top())], stroke);
    if is_closed {
        painter.line_segment([arch[8], egui::pos2(arch[8].x, body.top())], stroke);
        painter.rect_filled(body, 1.5, colour);
    } else {
        painter.rect_stroke(body, 1.5, stroke, egui::StrokeKind::Inside);
    }
    painter.line(arch, stroke);
}

fn alone(painter: &Painter, rect: Rect, colour: Color32, is_on: bool) {
    painter.circle_stroke(rect.center(), 5.0, Stroke::new(1.2, colour));
    if is_on {
        painter.circle_filled(rect.center(), 2.4, colour);
    }
}
