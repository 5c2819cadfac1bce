//! A box or a lasso over the view that selects control points.

use glam::DVec2;

use super::context::Context;
use super::gesture::{Gesture, Next};
use super::mode::{Depth, StrokeShape};
use super::overlay::Lit;
use crate::input::{Button, Pointer};
use crate::view::{Cursor, View};
use crate::workspace::Workspace;

/// An outline during its drawing.
#[derive(Debug)]
pub(crate) struct ControlBox {
    shape: StrokeShape,
    /// Corners in points of the view.
    points_px: Vec<DVec2>,
    /// True if the points inside are added to the present selection.
    adds: bool,
}

impl ControlBox {
    pub(super) fn begin(pointer: Pointer, shape: StrokeShape) -> Self {
        Self {
            shape,
            points_px: vec![pointer.position_px],
            adds: pointer.modifiers.shift,
        }
    }
}

impl Gesture for ControlBox {
    fn cursor(&self) -> Cursor {
        Cursor::Brush
    }

    fn lit(&self) -> Lit {
        Lit::Pointed
    }

    fn status(&self, _: &Workspace, _: &View) -> Option<String> {
        Some("Release to select the points inside, Esc to cancel".to_owned())
    }

    fn outline_px(&self) -> Vec<DVec2> {
        match (self.shape, self.points_px.as_slice()) {
            (StrokeShape::Lasso, points) => points.to_vec(),
            (_, [from, .., to]) => vec![*from, DVec2::new(to.x, from.y), *to, DVec2::new(from.x, to.y)],
            (_, points) => points.to_vec(),
        }
    }

    fn moved(&mut self, _: &mut Context<'_>, pointer: Pointer) -> Next {
        if self.shape != StrokeShape::Lasso {
            self.points_px.truncate(1);
        }
        self.points_px.push(pointer.position_px);
        Next::Stay
    }

    fn released(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        if button != Button::Primary {
            return Next::Stay;
        }
        self.moved(context, pointer);
        let outline_px = self.outline_px();
        let (camera, viewport_px) = (context.view.camera(), context.view.viewport_px());
        let takes_hidden = context.settings.depth == Depth::Through;
        let points = context.overlay.control_points.iter().zip(0..);
        let inside = points.filter_map(|(point, number)| {
            let at_px = camera.project(point.position, viewport_px)?;
            let is_taken = (takes_hidden || !point.is_hidden) && encloses(&outline_px, at_px);
            is_taken.then_some(number)
        });
        let inside: Vec<u32> = inside.collect();
        match self.adds {
            true => context.workspace.controls.add(inside),
            false => context.workspace.controls.put(inside),
        }
        Next::End
    }

    fn abort(&mut self, _: &mut Context<'_>) {}
}

/// Returns true if a closed line goes around a point, by the number of its crossings with a ray to the right.
fn encloses(outline: &[DVec2], point: DVec2) -> bool {
    let next = outline.iter().cycle().skip(1);
    let crossings = outline.iter().zip(next).filter(|(a, b)| {
        (a.y > point.y) != (b.y > point.y) && point.x < a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y)
    });
    crossings.count() % 2 == 1
}
