//! A straight line over the view, along which the surface is cut by the plane through the line and the eye.

use glam::DVec2;

use super::context::Context;
use super::cut_side::CutSide;
use super::gesture::{Gesture, Next};
use super::overlay::Lit;
use crate::cut::{CutPlane, KeptSide};
use crate::input::{Button, Pointer};
use crate::stitching::MeshChange;
use crate::view::{Cursor, View};
use crate::workspace::Workspace;

/// A shorter line, in points, has no sure direction.
const SHORTEST_PX: f64 = 8.0;

/// A line during its drawing.
#[derive(Debug)]
pub(crate) struct CutLine {
    from_px: DVec2,
    to_px: DVec2,
    side: CutSide,
}

impl CutLine {
    pub(super) fn begin(workspace: &Workspace, pointer: Pointer, kept: KeptSide) -> Self {
        Self {
            from_px: pointer.position_px,
            to_px: pointer.position_px,
            side: CutSide::begin(workspace, pointer, kept),
        }
    }

    fn follow(&mut self, pointer: Pointer) {
        self.to_px = pointer.position_px;
        self.side.follow(pointer);
    }

    /// The plane through the line and the eye; its normal points to the left of the line.
    fn plane(&self, view: &View) -> CutPlane {
        let ray = |px| view.camera().ray(px, view.viewport_px());
        let (from, to) = (ray(self.from_px), ray(self.to_px));
        let point = from.origin + from.direction;
        let along = to.origin + to.direction - point;
        let normal = along.cross(from.direction).normalize_or_zero();
        CutPlane {
            normal,
            distance: normal.dot(point),
        }
    }
}

impl Gesture for CutLine {
    fn cursor(&self) -> Cursor {
        Cursor::Brush
    }

    fn lit(&self) -> Lit {
        Lit::Gizmo(None)
    }

    fn status(&self, _: &Workspace, _: &View) -> Option<String> {
        Some(self.side.status("line"))
    }

    fn outline_px(&self) -> Vec<DVec2> {
        self.side.marked_px(&[self.from_px, self.to_px])
    }

    fn moved(&mut self, _: &mut Context<'_>, pointer: Pointer) -> Next {
        self.follow(pointer);
        Next::Stay
    }

    fn released(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        if button != Button::Primary {
            return Next::Stay;
        }
        self.follow(pointer);
        if self.from_px.distance(self.to_px) < SHORTEST_PX {
            return Next::End;
        }
        let plane = self.plane(context.view);
        self.side
            .cut(context, |kept, spared| MeshChange::Cut(plane, kept, spared));
        Next::End
    }

    fn abort(&mut self, _: &mut Context<'_>) {}
}
