//! A small picture of each method, for the list of methods: a bar that is fixed at its left end and bent upwards by a
//! handle at the other, with the elements that the method works on.
//!
//! Pictures are a few lines, drawn in the colours of the theme.

use std::f32::consts::{FRAC_PI_2, TAU};

use eframe::egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, Ui, Vec2, vec2};
use pliant_deform::Picture;

/// Width and height in points.
pub const SIZE: Vec2 = vec2(46.0, 31.0);

/// The fixed end of the bar's middle line, and the handle's distance from there, in points from the upper left corner.
const HELD: Vec2 = vec2(6.0, 23.0);
const WAY: Vec2 = vec2(31.0, -16.0);

/// Half the bar's thickness.
const HALF: f32 = 3.4;
/// The handle, as gold as the first that is painted.
const HANDLE: Color32 = Color32::from_rgb(232, 184, 48);

/// Draws the picture into `rect`, which is of [`SIZE`].
pub fn paint(ui: &Ui, rect: Rect, picture: Picture, colour: Color32) {
    let pen = Pen {
        painter: ui.painter(),
        origin: rect.min,
        strong: Stroke::new(1.4, colour),
        weak: Stroke::new(1.0, colour.gamma_multiply(0.55)),
    };
    match picture {
        Picture::Bar => pen.bar(pen.strong),
        Picture::Plate => pen.plate(),
        Picture::Blocks => pen.blocks(5, 0.92),
        Picture::Prisms => pen.prisms(),
        Picture::Triangles => pen.triangles(),
        Picture::Waves => pen.waves(),
        Picture::Arrows => pen.arrows(),
        Picture::Spikes => pen.spikes(),
        Picture::Frames => pen.frames(),
        Picture::Circles => pen.circles(),
        Picture::Moves => pen.moves(),
        Picture::Graph => pen.graph(),
        Picture::Lattice => pen.lattice(),
        Picture::Hull => pen.hull(),
        Picture::Cells => pen.cells(),
    }
    pen.ends();
}

/// A point of the bent bar, a quarter of an ellipse: `along` from 0, its fixed end, to 1, the handle, and `off` points
/// to its left.
fn bent(along: f32, off: f32) -> Vec2 {
    let angle = along * FRAC_PI_2;
    HELD + WAY * vec2(angle.sin(), 1.0 - angle.cos()) - normal(along) * off
}

/// The direction away from the middle of the bend.
fn normal(along: f32) -> Vec2 {
    let angle = along * FRAC_PI_2;
    (vec2(angle.sin(), -angle.cos()) / WAY).normalized()
}

fn even(count: usize) -> impl Iterator<Item = f32> {
    (0..=count).map(move |step| step as f32 / count as f32)
}

struct Pen<'a> {
    painter: &'a Painter,
    origin: Pos2,
    strong: Stroke,
    weak: Stroke,
}

impl Pen<'_> {
    fn at(&self, point: Vec2) -> Pos2 {
        self.origin + point
    }

    fn line(&self, points: impl IntoIterator<Item = Vec2>, stroke: Stroke) {
        let points = points.into_iter().map(|point| self.at(point)).collect();
        self.painter.add(Shape::line(points, stroke));
    }

    fn closed(&self, points: impl IntoIterator<Item = Vec2>, stroke: Stroke) {
        let points = points.into_iter().map(|point| self.at(point)).collect();
        self.painter.add(Shape::closed_line(points, stroke));
    }

    fn dot(&self, point: Vec2, radius: f32, colour: Color32) {
        self.painter.circle_filled(self.at(point), radius, colour);
    }

    /// A line along the bar, `off` points from its middle.
    fn along(&self, off: f32, stroke: Stroke) {
        self.line(even(16).map(|along| bent(along, off)), stroke);
    }

    fn across(&self, along: f32, half: f32, stroke: Stroke) {
        self.line([bent(along, -half), bent(along, half)], stroke);
    }

    /// The bar's two sides.
    fn bar(&self, stroke: Stroke) {
        self.along(-HALF, stroke);
        self.along(HALF, stroke);
    }

    /// The fixed and the moved part.
    fn ends(&self) {
        let held = Rect::from_center_size(self.at(bent(0.0, 0.0)), vec2(4.0, 7.0));
        self.painter.rect_filled(held, 1.0, self.weak.color);
        self.dot(bent(1.0, 0.0), 3.0, HANDLE);
    }

    /// A sheet from the side, like a spring.
    fn plate(&self) {
        self.along(0.0, Stroke::new(2.2, self.strong.color));
    }

    /// Neighbourhoods that only turn: squares along the bar, each as long as `share` of its part.
    fn blocks(&self, count: usize, share: f32) {
        for step in 0..count {
            let middle = (step as f32 + 0.5) / count as f32;
            let half = 0.5 * share / count as f32;
            let along = (bent(middle + half, 0.0) - bent(middle - half, 0.0)) * 0.5;
            let (centre, side) = (bent(middle, 0.0), normal(middle) * HALF);
            let corners = [along + side, along - side, -along - side, side - along];
            self.closed(corners.map(|corner| centre + corner), self.strong);
        }
    }

    /// Slabs side by side.
    fn prisms(&self) {
        self.bar(self.strong);
        even(8).for_each(|along| self.across(along, HALF, self.strong));
    }

    /// A strip of triangles.
    fn triangles(&self) {
        self.bar(self.strong);
        let corner = |(step, along): (usize, f32)| bent(along, if step % 2 == 0 { HALF } else { -HALF });
        self.line(even(10).enumerate().map(corner), self.weak);
    }

    /// A sheet that is wrinkled where it is bent.
    fn waves(&self) {
        let wave = |along: f32| {
            let height = 2.6 * (along * std::f32::consts::PI).sin();
            bent(along, height * (along * 7.0 * TAU).sin())
        };
        self.line(even(90).map(wave), self.strong);
    }

    /// Directions that turn along the bar.
    fn arrows(&self) {
        self.along(0.0, self.weak);
        for along in [0.12, 0.37, 0.62, 0.85] {
            let (root, way) = (bent(along, 0.0), normal(along).rot90() * 6.0);
            let tip = root + way;
            self.line([root, tip], self.strong);
            let barb = |side: f32| tip - way * 0.4 + way.rot90() * 0.3 * side;
            self.line([barb(1.0), tip, barb(-1.0)], self.strong);
        }
    }

    /// Details on the bar.
    fn spikes(&self) {
        let side = |(step, along): (usize, f32)| bent(along, if step % 2 == 0 { 0.0 } else { -5.0 });
        self.line(even(14).enumerate().map(side), self.strong);
        self.along(2.0, self.weak);
    }

    /// Axes that turn along the bar.
    fn frames(&self) {
        self.along(0.0, self.weak);
        for along in [0.15, 0.45, 0.75] {
            let (root, out) = (bent(along, 0.0), normal(along) * 6.0);
            self.line([root - out, root, root + out.rot90()], self.strong);
        }
    }

    /// The effect of each handle around it.
    fn circles(&self) {
        self.bar(self.weak);
        for along in [0.0, 0.5, 1.0] {
            for radius in [3.0, 6.0] {
                let centre = self.at(bent(along, 0.0));
                self.painter.circle_stroke(centre, radius, self.strong);
            }
        }
    }

    /// Points, and their moves.
    fn moves(&self) {
        for along in [0.3, 0.55, 0.8, 1.0] {
            let from = HELD + vec2(WAY.x * along, 0.0);
            let to = bent(along, 0.0);
            self.line([from, to], self.weak);
            self.dot(from, 1.2, self.weak.color);
            self.dot(to, 1.9, self.strong.color);
        }
    }

    /// Few nodes that carry the others.
    fn graph(&self) {
        self.bar(self.weak);
        let nodes = [
            (0.1, 0.0),
            (0.32, 3.0),
            (0.42, -3.0),
            (0.62, 2.0),
            (0.75, -3.0),
            (0.95, 0.0),
        ];
        let nodes = nodes.map(|(along, off)| bent(along, off));
        for [from, to] in [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3], [2, 4], [3, 4], [3, 5], [4, 5]] {
            self.line([nodes[from], nodes[to]], self.strong);
        }
        nodes.iter().for_each(|node| self.dot(*node, 2.0, self.strong.color));
    }

    /// A grid of points around the bar.
    fn lattice(&self) {
        self.bar(self.weak);
        for off in [-6.0, 0.0, 6.0] {
            self.along(off, self.strong);
            even(4).for_each(|along| self.dot(bent(along, off), 1.5, self.strong.color));
        }
        even(4).for_each(|along| self.across(along, 6.0, self.strong));
    }

    /// A coarse hull around the bar.
    fn hull(&self) {
        self.bar(self.weak);
        let out = [0.0, 0.5, 1.0].map(|along| bent(along, -7.0));
        let back = [1.0, 0.4, 0.0].map(|along| bent(along, 6.0));
        let corners: Vec<Vec2> = out.into_iter().chain(back).collect();
        corners
            .iter()
            .for_each(|corner| self.dot(*corner, 1.6, self.strong.color));
        self.closed(corners, self.strong);
    }

    /// Cubes around the bar, joined by their faces.
    fn cells(&self) {
        for off in [-3.6, 3.6] {
            for step in 0..5 {
                let middle = (step as f32 + 0.5) / 5.0;
                let (centre, out) = (bent(middle, off), normal(middle) * 2.6);
                let along = out.rot90();
                let corners = [out + along, out - along, -out - along, along - out];
                self.closed(corners.map(|corner| centre + corner), self.strong);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bar_and_what_stands_on_it_stay_within_the_picture() {
        let picture = Rect::from_min_size(Pos2::ZERO, SIZE);
        for along in even(32) {
            for off in [-7.0, 0.0, 6.0] {
                let point = bent(along, off);
                assert!(picture.contains(point.to_pos2()), "{along} {off}: {point:?}");
            }
        }
    }
}
