//! The legend of a colour scale: a bar with numbers. The window and `pliant render` paint it with the same function.

use egui::{Align2, Color32, FontId, Mesh, Painter, Pos2, Rect, Stroke, StrokeKind, pos2, vec2};
use pliant_render::{Image, RenderError, Renderer};

use crate::drawing::{Scale, colour_at};
use crate::painting;

/// Width and height in points.
pub const SIZE: egui::Vec2 = vec2(150.0, 222.0);

const BAR: Rect = Rect {
    min: pos2(16.0, 40.0),
    max: pos2(36.0, 204.0),
};

/// Paints the legend of `scale` with its upper left corner at `corner`.
pub fn paint(painter: &Painter, corner: Pos2, scale: &Scale) {
    let moved = |rect: Rect| rect.translate(corner.to_vec2());
    painter.rect_filled(Rect::from_min_size(corner, SIZE), 6.0, Color32::from_black_alpha(140));
    let text = Color32::from_gray(230);
    let title = corner + vec2(14.0, 19.0);
    painter.text(
        title,
        Align2::LEFT_CENTER,
        scale.title,
        FontId::proportional(12.0),
        text,
    );
    let bar = moved(BAR);
    let mut mesh = Mesh::default();
    const STEPS: u32 = 48;
    for step in 0..=STEPS {
        let share = step as f32 / STEPS as f32;
        let [r, g, b, _] = colour_at(f64::from(share));
        let y = bar.bottom() - share * bar.height();
        for x in [bar.left(), bar.right()] {
            mesh.colored_vertex(pos2(x, y), Color32::from_rgb(r, g, b));
        }
        if step > 0 {
            let at = 2 * step;
            mesh.add_triangle(at - 2, at - 1, at);
            mesh.add_triangle(at - 1, at + 1, at);
        }
    }
    painter.add(mesh);
    painter.rect_stroke(
        bar,
        0.0,
        Stroke::new(1.0, Color32::from_black_alpha(160)),
        StrokeKind::Outside,
    );
    for tick in &scale.ticks {
        let y = bar.bottom() - tick.at as f32 * bar.height();
        painter.hline(bar.right()..=bar.right() + 5.0, y, Stroke::new(1.0, text));
        let beside = pos2(bar.right() + 10.0, y);
        painter.text(
            beside,
            Align2::LEFT_CENTER,
            &tick.label,
            FontId::proportional(12.0),
            text,
        );
    }
}

/// The legend as an image with a transparent background, at `pixels_per_point`.
///
/// # Errors
/// As [`painting::picture`].
pub fn picture(renderer: &Renderer, scale: &Scale, pixels_per_point: f32) -> Result<Image, RenderError> {
    painting::picture(renderer, SIZE, pixels_per_point, |painter| {
        paint(painter, Pos2::ZERO, scale)
    })
}
