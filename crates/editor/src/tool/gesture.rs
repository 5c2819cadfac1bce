//! The pointer's gestures: a stroke, a drag, an orbit; each is a state machine in its own file.
//!
//! A button, a key or a command begins a gesture ([`super::begin`]). It gets every event until it ends, and is aborted
//! if something else interrupts it; an aborted gesture leaves no trace.

use glam::DVec2;

use super::context::Context;
use super::overlay::Lit;
use crate::input::{Button, Key, Modifiers, Pointer};
use crate::jobs::{Activity, Enclosed};
use crate::view::{ControlShape, Cursor, Readout, View};
use crate::workspace::Workspace;

/// The state of a gesture after an event.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Next {
    /// It continues.
    Stay,
    /// It has ended.
    End,
    /// It has ended, and the event may begin another gesture.
    EndBefore,
}

/// An active gesture.
pub(crate) trait Gesture: std::fmt::Debug {
    /// Its effect on jobs.
    fn activity(&self) -> Activity {
        Activity::Still
    }

    /// The look of the pointer.
    fn cursor(&self) -> Cursor;

    /// The overlay on the surface during it.
    fn lit(&self) -> Lit;

    /// A sentence for the status line, if it has one.
    fn status(&self, workspace: &Workspace, view: &View) -> Option<String>;

    /// The number to show beside the dragged object.
    fn readout(&self, _workspace: &Workspace, _view: &View) -> Option<Readout> {
        None
    }

    /// The closed line during its drawing over the view; empty if there is none.
    fn outline_px(&self) -> Vec<DVec2> {
        Vec::new()
    }

    /// The shapes shown over the surface besides [`Gesture::lit`], in world space.
    fn shapes(&self, _view: &View) -> Vec<ControlShape> {
        Vec::new()
    }

    /// Returns true if it moves the camera: then intermediate views do not enter the camera's history.
    fn moves_camera(&self) -> bool {
        false
    }

    /// Returns true if it measures with the camera of its beginning: then nothing else may zoom.
    fn holds_camera(&self) -> bool {
        false
    }

    /// Returns true if it waits for a job: a search for the vertices inside an outline, or for a joint.
    fn is_looking(&self) -> bool {
        false
    }

    /// The pointer moved.
    fn moved(&mut self, _context: &mut Context<'_>, _pointer: Pointer) -> Next {
        Next::Stay
    }

    /// A button went down: the right one aborts.
    fn pressed(&mut self, context: &mut Context<'_>, _pointer: Pointer, button: Button) -> Next {
        if button == Button::Secondary {
            self.abort(context);
            return Next::End;
        }
        Next::Stay
    }

    /// A button went up.
    fn released(&mut self, _context: &mut Context<'_>, _pointer: Pointer, _button: Button) -> Next {
        Next::Stay
    }

    /// A key went down; `None` if the gesture does not use it. Escape aborts.
    fn key(&mut self, context: &mut Context<'_>, key: Key, _modifiers: Modifiers) -> Option<Next> {
        (key == Key::Escape).then(|| {
            self.abort(context);
            Next::End
        })
    }

    /// A job has found the vertices inside the outline, or along the line.
    fn found(&mut self, _context: &mut Context<'_>, _found: Enclosed) -> Next {
        Next::Stay
    }

    /// A job has ended its search for a joint.
    fn found_joint(&mut self, _context: &mut Context<'_>) -> Next {
        Next::Stay
    }

    /// The flow on the surface has taken a step.
    fn flowed(&mut self, _context: &mut Context<'_>) -> Next {
        Next::Stay
    }

    /// Restores the earlier state.
    fn abort(&mut self, context: &mut Context<'_>);
}
