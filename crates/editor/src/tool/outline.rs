//! A lasso or a box over the view: what stands inside of it when the button goes up is painted as a stroke would.

use glam::DVec2;
use pliant_mesh::SurfaceVertex;
use rayon::prelude::*;

use super::Tool;
use super::paint::PaintStroke;
use crate::editor::Editor;
use crate::picking::Picking;
use crate::{Button, Pointer};

/// How the left button takes vertices.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum StrokeShape {
    /// With the brush.
    #[default]
    Brush,
    /// Within a line drawn freely around them.
    Lasso,
    /// Within a box.
    Box,
    /// All that hang together with the one under the pointer.
    Component,
}

/// How deep a lasso or a box goes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Depth {
    /// Only what is seen.
    #[default]
    Visible,
    /// Through the surface to its back.
    Through,
}

/// An outline that is being drawn.
#[derive(Debug)]
pub(crate) struct OutlineStroke {
    shape: StrokeShape,
    /// Corners in points of the view.
    points_px: Vec<DVec2>,
    /// What takes the vertices in the end.
    stroke: PaintStroke,
}

impl OutlineStroke {
    pub(crate) fn begin(editor: &mut Editor, pointer: Pointer, shape: StrokeShape) -> Option<Self> {
        let stroke = PaintStroke::begin_without_dab(editor, pointer)?;
        Some(Self {
            shape,
            points_px: vec![pointer.position_px],
            stroke,
        })
    }

    /// The closed line as it is drawn.
    pub(crate) fn outline_px(&self) -> Vec<DVec2> {
        match (self.shape, self.points_px.as_slice()) {
            (StrokeShape::Box, [from, .., to]) => vec![*from, DVec2::new(to.x, from.y), *to, DVec2::new(from.x, to.y)],
            _ => self.points_px.clone(),
        }
    }

    pub(crate) fn status(&self) -> String {
        let shape = if self.shape == StrokeShape::Box { "box" } else { "lasso" };
        format!("Drawing a {shape}: let go to paint what is inside, Esc to leave it")
    }

    pub(crate) fn moved(mut self: Box<Self>, pointer: Pointer) -> Tool {
        // Not every pixel is a corner.
        if self
            .points_px
            .last()
            .is_none_or(|last| last.distance(pointer.position_px) >= 2.0)
        {
            if self.shape == StrokeShape::Box {
                self.points_px.truncate(1);
            }
            self.points_px.push(pointer.position_px);
        }
        Tool::Outline(self)
    }

    pub(crate) fn released(self: Box<Self>, editor: &mut Editor, pointer: Pointer, button: Button) -> Tool {
        if button != Button::Primary {
            return Tool::Outline(self);
        }
        let Tool::Outline(outline) = self.moved(pointer) else {
            return Tool::Idle;
        };
        let polygon = outline.outline_px();
        let inside = match editor.picking() {
            Some(picking) => vertices_inside(&picking, &polygon, editor.depth),
            None => Vec::new(),
        };
        outline.stroke.finish_with(editor, inside);
        Tool::Idle
    }

    pub(crate) fn abort(self, editor: &mut Editor) {
        self.stroke.abort(editor);
    }
}

/// The vertices whose picture lies in the closed line, ascending.
fn vertices_inside(picking: &Picking<'_>, polygon: &[DVec2], depth: Depth) -> Vec<SurfaceVertex> {
    if polygon.len() < 3 {
        return Vec::new();
    }
    let (low, high) = polygon
        .iter()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| {
            (low.min(*p), high.max(*p))
        });
    (0..picking.model.surface.positions.len() as u32)
        .into_par_iter()
        .with_min_len(4096)
        .map(SurfaceVertex)
        .filter(|&vertex| {
            let position = picking.position(vertex);
            let Some(px) = picking.sight.project(position) else {
                return false;
            };
            let is_inside = px.cmpge(low).all() && px.cmple(high).all() && is_inside(px, polygon);
            if !is_inside || depth == Depth::Through {
                return is_inside;
            }
            // Where the line of sight through the vertex begins: the eye itself, but for an orthographic view.
            let eye = picking.camera.ray(px, picking.viewport_px).origin;
            picking.is_seen(vertex, position, eye)
        })
        .collect()
}

/// Whether a point lies within a closed line, by the number of edges to its right.
fn is_inside(p: DVec2, polygon: &[DVec2]) -> bool {
    let next = polygon.iter().cycle().skip(1);
    polygon
        .iter()
        .zip(next)
        .filter(|(a, b)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
        .count()
        % 2
        == 1
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::is_inside;

    #[test]
    fn a_hook_has_its_mouth_outside() {
        let hook = [
            (0.0, 0.0),
            (6.0, 0.0),
            (6.0, 6.0),
            (4.0, 6.0),
            (4.0, 2.0),
            (2.0, 2.0),
            (2.0, 6.0),
            (0.0, 6.0),
        ];
        let hook = hook.map(|(x, y)| DVec2::new(x, y));
        for (x, y, inside) in [
            (1.0, 5.0, true),
            (3.0, 4.0, false),
            (5.0, 5.0, true),
            (3.0, 1.0, true),
            (7.0, 3.0, false),
        ] {
            assert_eq!(is_inside(DVec2::new(x, y), &hook), inside, "{x} {y}");
        }
    }
}
