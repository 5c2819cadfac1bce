//! Strokes of the brush, from button down to button up: each is one step, and Escape aborts it.
//!
//! A [`Stroke`] is the effect on the vertices under the brush; its timing is the same for all strokes.

use glam::DVec2;
use pliant_mesh::SurfaceVertex;

use super::context::Context;
use super::gesture::{Gesture, Next};
use super::overlay::Lit;
use crate::document::{Document, Transaction};
use crate::input::{Button, Pointer};
use crate::jobs::Activity;
use crate::view::{Cursor, View};
use crate::workspace::Workspace;

/// The stroke's action.
pub(crate) trait Stroke: std::fmt::Debug {
    /// The pointer moved from one point of the viewport to another; `before` is the document at the beginning of the
    /// stroke.
    fn dab(&mut self, context: &mut Context<'_>, before: &Document, way_px: [DVec2; 2]);

    /// Its text in the status line.
    fn doing(&self, workspace: &Workspace) -> String;

    /// The button went up: the rest of the work before the end of the step.
    fn finish(&mut self, _workspace: &mut Workspace, _before: &Document) {}

    /// The look of the pointer.
    fn cursor(&self) -> Cursor {
        Cursor::Brush
    }

    /// Returns true if it measures with the camera of its beginning.
    fn holds_camera(&self) -> bool {
        false
    }

    /// Returns true if it acts again at every step of the flow, even if the pointer rests.
    fn goes_on_by_itself(&self, _workspace: &Workspace) -> bool {
        false
    }
}

/// An active stroke.
#[derive(Debug)]
pub(super) struct StrokeGesture<S> {
    transaction: Transaction,
    stroke: S,
    last_px: DVec2,
}

impl<S: Stroke> StrokeGesture<S> {
    /// Begins a stroke, without a dab.
    pub fn new(transaction: Transaction, stroke: S, pointer: Pointer) -> Self {
        Self {
            transaction,
            stroke,
            last_px: pointer.position_px,
        }
    }

    /// Begins a stroke with a first dab under the pointer.
    pub fn begin(context: &mut Context<'_>, transaction: Transaction, stroke: S, pointer: Pointer) -> Self {
        let mut gesture = Self::new(transaction, stroke, pointer);
        gesture.dab(context, pointer.position_px);
        gesture
    }

    /// Moves the brush to a point of the viewport.
    pub fn dab(&mut self, context: &mut Context<'_>, to_px: DVec2) {
        let from_px = std::mem::replace(&mut self.last_px, to_px);
        self.stroke.dab(context, self.transaction.before(), [from_px, to_px]);
    }

    /// Changes further vertices.
    pub fn go_on_with(&mut self, workspace: &mut Workspace, change: impl FnOnce(&mut S, &mut Workspace)) {
        change(&mut self.stroke, workspace);
    }

    /// Changes further vertices, and ends.
    pub fn finish_with(&mut self, workspace: &mut Workspace, change: impl FnOnce(&mut S, &mut Workspace)) {
        self.go_on_with(workspace, change);
        self.stroke.finish(workspace, self.transaction.before());
        workspace.commit(&self.transaction);
    }
}

impl<S: Stroke> Gesture for StrokeGesture<S> {
    fn activity(&self) -> Activity {
        Activity::Painting
    }

    fn cursor(&self) -> Cursor {
        self.stroke.cursor()
    }

    fn lit(&self) -> Lit {
        Lit::Ring
    }

    fn status(&self, workspace: &Workspace, _: &View) -> Option<String> {
        Some(format!("{}: Esc to cancel", self.stroke.doing(workspace)))
    }

    fn holds_camera(&self) -> bool {
        self.stroke.holds_camera()
    }

    fn moved(&mut self, context: &mut Context<'_>, pointer: Pointer) -> Next {
        self.dab(context, pointer.position_px);
        Next::Stay
    }

    fn released(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        if button != Button::Primary {
            return Next::Stay;
        }
        if pointer.position_px != self.last_px {
            self.dab(context, pointer.position_px);
        }
        self.finish_with(context.workspace, |_, _| {});
        Next::End
    }

    fn flowed(&mut self, context: &mut Context<'_>) -> Next {
        if self.stroke.goes_on_by_itself(context.workspace) {
            self.dab(context, self.last_px);
        }
        Next::Stay
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        context.workspace.abort(&self.transaction);
    }
}

/// Calls `visit` for every vertex under the brush as it moves from one point of the viewport to another, with its
/// distance from the brush's middle as a share of the radius; vertices may be visited more than once.
pub(super) fn meet(context: &mut Context<'_>, way_px: [DVec2; 2], visit: impl FnMut(SurfaceVertex, f64)) {
    if let Some(picking) = context.workspace.picking(context.view) {
        let size = &context.settings.brush();
        context.brush.stroke(&picking, &way_px, size, visit);
    }
}

/// The vertices that may be changed under the brush and, with symmetry, opposite it: in order, each once, with its
/// largest firmness. `firmness` takes the distance from the brush's middle as a share of the radius.
pub(super) fn firmest(
    context: &mut Context<'_>,
    way_px: [DVec2; 2],
    firmness: impl Fn(f64) -> f64,
) -> Vec<(SurfaceVertex, f64)> {
    let mut met = under_brush(context, way_px, firmness);
    if let Some(sides) = context.workspace.both_sides() {
        met.extend(sides.opposite_with(&met));
    }
    once(met, context.workspace)
}

/// The same without symmetry.
pub(super) fn firmest_on_one_side(
    context: &mut Context<'_>,
    way_px: [DVec2; 2],
    firmness: impl Fn(f64) -> f64,
) -> Vec<(SurfaceVertex, f64)> {
    let met = under_brush(context, way_px, firmness);
    once(met, context.workspace)
}

fn under_brush(
    context: &mut Context<'_>,
    way_px: [DVec2; 2],
    firmness: impl Fn(f64) -> f64,
) -> Vec<(SurfaceVertex, f64)> {
    let mut met = Vec::new();
    meet(context, way_px, |vertex, share| met.push((vertex, firmness(share))));
    met
}

/// The vertices that may be changed, in order, each once, with its largest firmness.
fn once(mut met: Vec<(SurfaceVertex, f64)>, workspace: &Workspace) -> Vec<(SurfaceVertex, f64)> {
    met.retain(|(vertex, _)| workspace.vertex_access.may_be_painted(vertex.index()));
    met.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
    met.dedup_by_key(|(vertex, _)| *vertex);
    met
}
