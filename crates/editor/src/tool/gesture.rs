//! What the pointer is doing: a stroke, a drag, an orbit; each is a state machine in a file of its own.
//!
//! A gesture is begun by a button, a key or a command ([`super::begin`]). It gets every event until it ends, and is
//! aborted if something else interrupts it; an aborted gesture leaves no trace.

use glam::DVec2;
use pliant_mesh::SurfaceVertex;

use super::context::Context;
use super::overlay::Lit;
use crate::input::{Button, Key, Modifiers, Pointer};
use crate::jobs::Activity;
use crate::scene_view::{Cursor, Readout};
use crate::view::{ControlShape, View};
use crate::workspace::Workspace;

/// What comes after an event that a gesture was told of.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Next {
    /// It goes on.
    Stay,
    /// It has ended.
    End,
    /// It has ended, and the event may begin something else.
    EndBefore,
}

/// A gesture that goes on.
pub(crate) trait Gesture: std::fmt::Debug {
    /// What it means for jobs.
    fn activity(&self) -> Activity {
        Activity::Still
    }

    /// What the pointer looks like.
    fn cursor(&self) -> Cursor;

    /// What is shown over the surface meanwhile.
    fn lit(&self) -> Lit;

    /// A sentence for the status line, if there is something to tell.
    fn status(&self, workspace: &Workspace, view: &View) -> Option<String>;

    /// The number to show beside what is dragged.
    fn readout(&self, _workspace: &Workspace, _view: &View) -> Option<Readout> {
        None
    }

    /// The closed line that is being drawn over the view; empty where none is.
    fn outline_px(&self) -> Vec<DVec2> {
        Vec::new()
    }

    /// What is shown over the surface beside what [`Gesture::lit`] says, in world space.
    fn shapes(&self, _view: &View) -> Vec<ControlShape> {
        Vec::new()
    }

    /// Whether it moves the camera: then the views on its way do not enter the camera's history.
    fn moves_camera(&self) -> bool {
        false
    }

    /// Whether it measures with the camera that it began with: then nothing else may zoom.
    fn holds_camera(&self) -> bool {
        false
    }

    /// Whether it waits for a job: the one that finds the vertices inside of an outline, or a joint.
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

    /// A key went down; `None` if it is not the gesture's own. Escape aborts.
    fn key(&mut self, context: &mut Context<'_>, key: Key, _modifiers: Modifiers) -> Option<Next> {
        (key == Key::Escape).then(|| {
            self.abort(context);
            Next::End
        })
    }

    /// A job has found what the outline holds.
    fn found(&mut self, _context: &mut Context<'_>, _inside: Vec<SurfaceVertex>) -> Next {
        Next::Stay
    }

    /// A job has looked for a joint.
    fn found_joint(&mut self, _context: &mut Context<'_>) -> Next {
        Next::Stay
    }

    /// Puts everything back to how it was before.
    fn abort(&mut self, context: &mut Context<'_>);
}
