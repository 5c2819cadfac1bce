//! The side of a line or curve that a cut deletes: in words, as marks, and for the cut itself.

use glam::DVec2;
use pliant_mesh::SurfaceVertex;

use super::context::Context;
use crate::cut::{CutStroke, KeptSide};
use crate::input::Pointer;
use crate::stitching::MeshChange;
use crate::workspace::{Workspace, held_parts, spared_by_cuts, stitch};

/// The length of the marks on the deleted side, in points, and the distance between them.
const MARK_PX: f64 = 9.0;

/// The side that is kept while a line is drawn.
#[derive(Debug)]
pub(super) struct CutSide {
    /// The positive side is to the left of the line, seen along it.
    kept: KeptSide,
    /// True while Shift is held: the other side is kept.
    is_turned: bool,
    /// The name of the handle whose part alone is cut.
    only: Option<String>,
}

impl CutSide {
    pub(super) fn begin(workspace: &Workspace, pointer: Pointer, kept: KeptSide) -> Self {
        let holds_part = !held_parts(workspace).is_empty();
        let only = workspace.selected().filter(|_| holds_part);
        Self {
            kept,
            is_turned: pointer.modifiers.shift,
            only: only.map(|handle| handle.name.clone()),
        }
    }

    pub(super) fn follow(&mut self, pointer: Pointer) {
        self.is_turned = pointer.modifiers.shift;
    }

    fn kept(&self) -> KeptSide {
        match (self.kept, self.is_turned) {
            (KeptSide::Positive, true) => KeptSide::Negative,
            (KeptSide::Negative, true) => KeptSide::Positive,
            (kept, _) => kept,
        }
    }

    /// The effect of a release; `line` names the line.
    pub(super) fn status(&self, line: &str) -> String {
        let only = self.only.as_ref().map(|name| format!("Only {name} is cut. "));
        let only = only.unwrap_or_default();
        let turn = match self.kept {
            KeptSide::Both => "",
            KeptSide::Positive | KeptSide::Negative => ", Shift for the other side",
        };
        let effect = effect(self.kept(), line);
        format!("{only}{effect}: release to cut{turn}, Esc to cancel")
    }

    /// A line over the view, with marks on the side that is deleted.
    pub(super) fn marked_px(&self, line_px: &[DVec2]) -> Vec<DVec2> {
        let mut marked = Vec::new();
        // The way since the last mark.
        let mut since = 0.0;
        for pair in line_px.windows(2) {
            let along = pair[1] - pair[0];
            let left = DVec2::new(along.y, -along.x).normalize_or_zero();
            let mark = MARK_PX
                * match self.kept() {
                    KeptSide::Positive => -left,
                    KeptSide::Negative => left,
                    KeptSide::Both => DVec2::ZERO,
                };
            marked.push(pair[0]);
            let mut at = MARK_PX - since;
            while at < along.length() {
                let place = pair[0] + along.normalize_or_zero() * at;
                marked.extend([place, place + mark, place]);
                at += MARK_PX;
            }
            since = along.length() - (at - MARK_PX);
        }
        marked.extend(line_px.last());
        marked
    }

    /// Cuts everything that is shown and not locked, by the change for the kept side and the spared vertices.
    pub(super) fn cut(
        &self,
        context: &mut Context<'_>,
        change: impl FnOnce(KeptSide, Vec<SurfaceVertex>) -> MeshChange,
    ) {
        context.settings.wants_cut = None;
        let spared = spared_by_cuts(context.workspace);
        if spared.len() == context.workspace.document.paint().len() {
            let why = "Every part is hidden or locked: show or unlock the one to cut.";
            context.workspace.refuse(why);
            return;
        }
        stitch(context.workspace, change(self.kept(), spared));
    }
}

/// The line to draw, and the effect of the cut along it.
pub(crate) fn hint(stroke: CutStroke) -> String {
    match stroke {
        CutStroke::Line(kept) => format!("Drag a line across the shape. {}", effect(kept, "line")),
        CutStroke::Curve(kept) => format!(
            "Draw a curve on the surface, back to its start, around a limb or from border to border. {}",
            effect(kept, "curve")
        ),
    }
}

/// The effect of a cut, in words.
fn effect(kept: KeptSide, line: &str) -> String {
    match kept {
        KeptSide::Positive => format!("The part to the right of the {line}, seen along it, is deleted"),
        KeptSide::Negative => format!("The part to the left of the {line}, seen along it, is deleted"),
        KeptSide::Both => format!("The surface gets edges along the {line}, and nothing is deleted"),
    }
}
