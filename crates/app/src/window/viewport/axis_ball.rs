//! The axes in the view's corner, to see which way is up and to click for looking along one; and numbers beside marks.

use eframe::egui::{self, Align2, Color32, FontId, Painter, Pos2, Rect, Sense, Stroke, pos2, vec2};
use glam::DVec3;
use pliant_editor::{Camera, Command, NamedView, UpAxis};

const RADIUS: f32 = 34.0;
const KNOB: f32 = 9.5;
const MARGIN: f32 = 14.0;

/// The gizmo's x, y and z.
const COLOURS: [Color32; 3] = [
    Color32::from_rgb(226, 62, 72),
    Color32::from_rgb(106, 176, 48),
    Color32::from_rgb(58, 122, 228),
];

/// One end of an axis.
#[derive(Clone, Copy, Debug)]
struct Knob {
    axis: usize,
    is_positive: bool,
    at: Pos2,
    /// Towards the eye.
    depth: f64,
}

/// Returns true if a point of the window is on the ball of a view at `view`.
pub fn contains(view: Rect, position: Option<Pos2>) -> bool {
    position.is_some_and(|position| position.distance(middle(view)) <= RADIUS + KNOB)
}

/// Shows the ball in the corner of `view`; returns the command of a click on it.
pub fn show(ui: &egui::Ui, view: Rect, camera: &Camera) -> Option<Command> {
    if view.width() < 6.0 * RADIUS || view.height() < 6.0 * RADIUS {
        return None;
    }
    let middle = middle(view);
    let area = Rect::from_center_size(middle, egui::Vec2::splat(2.0 * (RADIUS + KNOB)));
    let response = ui.interact(area, egui::Id::unique("axis ball"), Sense::click());
    let mut knobs = knobs(camera, middle);
    knobs.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    let under = |position: Pos2| {
        let near = knobs.iter().rev().find(|knob| knob.at.distance(position) <= KNOB + 1.5);
        near.copied()
    };
    let hovered = response.hover_pos().and_then(under);
    let painter = ui.painter_at(view);
    if response.hovered() {
        painter.circle_filled(middle, RADIUS + KNOB + 2.0, Color32::from_white_alpha(18));
    }
    for knob in &knobs {
        let is_hovered = hovered.is_some_and(|other| other.axis == knob.axis && other.is_positive == knob.is_positive);
        paint(&painter, middle, knob, is_hovered);
    }
    let clicked = response
        .interact_pointer_pos()
        .filter(|_| response.clicked())
        .and_then(under)?;
    Some(Command::View(side(camera.up, clicked.axis, clicked.is_positive)))
}

/// A number beside a mark.
pub fn readout(painter: &Painter, at: Pos2, text: &str) {
    let font = FontId::monospace(14.0);
    let text = painter.layout_no_wrap(text.to_owned(), font, Color32::WHITE);
    let size = text.size() + vec2(12.0, 6.0);
    painter.rect_filled(Rect::from_min_size(at, size), 4.0, Color32::from_black_alpha(190));
    painter.galley(at + vec2(6.0, 3.0), text, Color32::WHITE);
}

fn middle(view: Rect) -> Pos2 {
    let inset = MARGIN + RADIUS + KNOB;
    pos2(view.right() - inset, view.top() + inset)
}

fn knobs(camera: &Camera, middle: Pos2) -> Vec<Knob> {
    let axes = camera.axes();
    let ends = (0..3).flat_map(|axis| [(axis, true), (axis, false)]);
    ends.map(|(axis, is_positive)| {
        let direction = DVec3::AXES[axis] * if is_positive { 1.0 } else { -1.0 };
        let seen = axes.transpose() * direction;
        Knob {
            axis,
            is_positive,
            at: middle + vec2(seen.x as f32, -seen.y as f32) * RADIUS,
            depth: seen.z,
        }
    })
    .collect()
}

fn paint(painter: &Painter, middle: Pos2, knob: &Knob, is_hovered: bool) {
    // Axes that point away are dimmer.
    let share = (0.55 + 0.45 * knob.depth) as f32;
    let colour = COLOURS[knob.axis];
    let dimmed = colour.lerp_to_gamma(Color32::from_rgb(60, 64, 70), 0.6 * (1.0 - share));
    let letter = ["X", "Y", "Z"][knob.axis];
    if knob.is_positive {
        painter.line_segment([middle, knob.at], Stroke::new(2.5, dimmed));
        painter.circle_filled(knob.at, KNOB, dimmed);
    } else {
        painter.circle(
            knob.at,
            KNOB - 1.5,
            dimmed.gamma_multiply(0.35),
            Stroke::new(1.5, dimmed),
        );
    }
    if knob.is_positive || is_hovered {
        let text = if is_hovered {
            Color32::WHITE
        } else {
            Color32::from_gray(20)
        };
        painter.text(knob.at, Align2::CENTER_CENTER, letter, FontId::proportional(12.0), text);
    }
}

/// The view from an axis's end.
fn side(up: UpAxis, axis: usize, is_positive: bool) -> NamedView {
    let views = match up {
        UpAxis::Y => [
            [NamedView::Left, NamedView::Right],
            [NamedView::Bottom, NamedView::Top],
            [NamedView::Back, NamedView::Front],
        ],
        // With z up the front looks along +y.
        UpAxis::Z => [
            [NamedView::Left, NamedView::Right],
            [NamedView::Front, NamedView::Back],
            [NamedView::Bottom, NamedView::Top],
        ],
    };
    views[axis][usize::from(is_positive)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_knob_that_was_clicked_comes_to_face_the_eye() {
        for up in [UpAxis::Y, UpAxis::Z] {
            for axis in 0..3 {
                for is_positive in [false, true] {
                    let mut camera = Camera {
                        up,
                        ..Camera::default()
                    };
                    camera.look_from(side(up, axis, is_positive));
                    let knobs = knobs(&camera, Pos2::ZERO);
                    let facing = knobs.iter().max_by(|a, b| a.depth.total_cmp(&b.depth));
                    assert_eq!(
                        facing.map(|knob| (knob.axis, knob.is_positive)),
                        Some((axis, is_positive))
                    );
                }
            }
        }
    }
}
