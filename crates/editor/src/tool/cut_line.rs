//! A straight line over the view, along which the surface is cut by the plane through the line and the eye.

use glam::DVec2;

use super::context::Context;
use super::gesture::{Gesture, Next};
use super::overlay::Lit;
use crate::input::{Button, Pointer};
use crate::stitching::{CutPlane, KeptSide, MeshChange};
use crate::view::{Cursor, View};
use crate::workspace::{Workspace, held_parts, spared_by_cuts, stitch};

/// A shorter line, in points, has no sure direction.
const SHORTEST_PX: f64 = 8.0;
/// The length of the marks on the deleted side, in points, and the distance between them.
const MARK_PX: f64 = 9.0;

/// A line during its drawing.
#[derive(Debug)]
pub(crate) struct CutLine {
    from_px: DVec2,
    to_px: DVec2,
    /// The positive side is to the left of the line, seen along it.
    kept: KeptSide,
    /// True while Shift is held: the other side is kept.
    is_turned: bool,
    /// The name of the handle whose part alone is cut.
    only: Option<String>,
}

impl CutLine {
    pub(super) fn begin(workspace: &Workspace, pointer: Pointer, kept: KeptSide) -> Self {
        let holds_part = !held_parts(workspace).is_empty();
        let only = workspace.selected().filter(|_| holds_part);
        Self {
            from_px: pointer.position_px,
            to_px: pointer.position_px,
            kept,
            is_turned: pointer.modifiers.shift,
            only: only.map(|handle| handle.name.clone()),
        }
    }

    fn kept(&self) -> KeptSide {
        match (self.kept, self.is_turned) {
            (KeptSide::Positive, true) => KeptSide::Negative,
            (KeptSide::Negative, true) => KeptSide::Positive,
            (kept, _) => kept,
        }
    }

    fn follow(&mut self, pointer: Pointer) {
        self.to_px = pointer.position_px;
        self.is_turned = pointer.modifiers.shift;
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
        let only = self.only.as_ref().map(|name| format!("Only {name} is cut. "));
        let only = only.unwrap_or_default();
        let turn = match self.kept {
            KeptSide::Both => "",
            KeptSide::Positive | KeptSide::Negative => ", Shift for the other side",
        };
        let effect = effect(self.kept());
        Some(format!("{only}{effect}: release to cut{turn}, Esc to cancel"))
    }

    /// The line, and marks on the side that is deleted.
    fn outline_px(&self) -> Vec<DVec2> {
        let along = self.to_px - self.from_px;
        let left = DVec2::new(along.y, -along.x).normalize_or_zero();
        let mark = MARK_PX
            * match self.kept() {
                KeptSide::Positive => -left,
                KeptSide::Negative => left,
                KeptSide::Both => DVec2::ZERO,
            };
        let count = (along.length() / MARK_PX).floor() as usize;
        let places = (1..count).map(|number| self.from_px + along * (number as f64 / count as f64));
        let marks = places.flat_map(|place| [place, place + mark, place]);
        std::iter::once(self.from_px).chain(marks).chain([self.to_px]).collect()
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
        context.settings.wants_cut = None;
        let spared = spared_by_cuts(context.workspace);
        if spared.len() == context.workspace.document.paint().len() {
            context
                .workspace
                .refuse("Every part is hidden or locked: show or unlock the one to cut.");
            return Next::End;
        }
        let change = MeshChange::Cut(self.plane(context.view), self.kept(), spared);
        stitch(context.workspace, change);
        Next::End
    }

    fn abort(&mut self, _: &mut Context<'_>) {}
}

/// The effect of a cut, in words.
pub(crate) fn effect(kept: KeptSide) -> &'static str {
    match kept {
        KeptSide::Positive => "The part to the right of the line, seen along it, is deleted",
        KeptSide::Negative => "The part to the left of the line, seen along it, is deleted",
        KeptSide::Both => "The surface gets edges along the line, and nothing is deleted",
    }
}
