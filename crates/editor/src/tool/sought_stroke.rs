//! A stroke whose vertices a job finds, such as those inside a lasso or of the limb around a drawn spine.
//!
//! All of these show themselves, wait for the job and end alike. What each of them draws, seeks and paints is its
//! [`Drawing`].

use glam::DVec2;

use super::context::Context;
use super::gesture::{Gesture, Next};
use super::overlay::Lit;
use super::paint::PaintStroke;
use super::stroke::StrokeGesture;
use crate::input::{Button, Pointer};
use crate::jobs::{Activity, Enclosed};
use crate::view::{Cursor, View};
use crate::workspace::Workspace;

/// The line or outline that is drawn, and the search for its vertices.
pub(super) trait Drawing: std::fmt::Debug {
    /// Its sentence for the status line; `None` for that of the stroke.
    fn status(&self) -> Option<String>;

    /// The closed line during its drawing over the view; empty if there is none.
    fn outline_px(&self) -> Vec<DVec2> {
        Vec::new()
    }

    /// Returns true if it is drawn and waits for a job.
    fn is_looking(&self) -> bool;

    /// Returns true if it measures with the camera of its beginning.
    fn holds_camera(&self) -> bool {
        false
    }

    /// The pointer moved while it is drawn.
    fn moved(&mut self, context: &mut Context<'_>, pointer: Pointer);

    /// It is drawn to its end.
    fn released(&mut self, context: &mut Context<'_>) -> Outcome;

    /// A job has found vertices.
    fn found(&mut self, context: &mut Context<'_>, found: Enclosed) -> Outcome;
}

/// A change of the document by what was found.
pub(super) type Change = Box<dyn FnOnce(&mut PaintStroke, &mut Workspace)>;

/// What a drawing leads to.
pub(super) enum Outcome {
    /// A job searches.
    Looks,
    /// The stroke paints, and goes on.
    Paints(Change),
    /// The stroke paints, and ends.
    Ends(Change),
    /// The stroke leaves no trace but this sentence.
    Refuses(&'static str),
}

/// A stroke with its drawing.
#[derive(Debug)]
pub(super) struct SoughtStroke<D> {
    /// The stroke that paints the vertices.
    stroke: StrokeGesture<PaintStroke>,
    drawing: D,
}

impl<D: Drawing> SoughtStroke<D> {
    pub(super) fn new(stroke: StrokeGesture<PaintStroke>, drawing: D) -> Self {
        Self { stroke, drawing }
    }

    /// Begins a stroke that makes a new handle; `None`, with a sentence, if it can't.
    pub(super) fn of_new_handle(context: &mut Context<'_>, pointer: Pointer, drawing: D) -> Option<Self> {
        context.workspace.selection.wants_new_handle = true;
        let stroke = PaintStroke::begin(context.workspace, context.settings, pointer)?;
        Some(Self::new(stroke, drawing))
    }

    fn go_on(&mut self, context: &mut Context<'_>, outcome: Outcome) -> Next {
        match outcome {
            Outcome::Looks => Next::Stay,
            Outcome::Paints(change) => {
                self.stroke.go_on_with(context.workspace, change);
                Next::Stay
            }
            Outcome::Ends(change) => {
                self.stroke.finish_with(context.workspace, change);
                Next::End
            }
            Outcome::Refuses(why) => {
                self.abort(context);
                context.workspace.refuse(why);
                Next::End
            }
        }
    }
}

impl<D: Drawing> Gesture for SoughtStroke<D> {
    fn activity(&self) -> Activity {
        self.stroke.activity()
    }

    fn cursor(&self) -> Cursor {
        self.stroke.cursor()
    }

    fn lit(&self) -> Lit {
        self.stroke.lit()
    }

    fn status(&self, workspace: &Workspace, view: &View) -> Option<String> {
        self.drawing.status().or_else(|| self.stroke.status(workspace, view))
    }

    fn outline_px(&self) -> Vec<DVec2> {
        self.drawing.outline_px()
    }

    fn is_looking(&self) -> bool {
        self.drawing.is_looking()
    }

    fn holds_camera(&self) -> bool {
        self.drawing.holds_camera()
    }

    fn moved(&mut self, context: &mut Context<'_>, pointer: Pointer) -> Next {
        if !self.is_looking() {
            self.drawing.moved(context, pointer);
        }
        Next::Stay
    }

    fn released(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        if button != Button::Primary || self.is_looking() {
            return Next::Stay;
        }
        self.moved(context, pointer);
        let outcome = self.drawing.released(context);
        self.go_on(context, outcome)
    }

    fn found(&mut self, context: &mut Context<'_>, found: Enclosed) -> Next {
        let outcome = self.drawing.found(context, found);
        self.go_on(context, outcome)
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        context.workspace.jobs.stop_asking(|slots| &mut slots.enclose);
        self.stroke.abort(context);
    }
}
