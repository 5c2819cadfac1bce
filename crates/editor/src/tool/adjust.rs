//! The drag of a widget: the changes of its commands are shown at once and become one step at the end. The step itself
//! belongs to the workspace, because commands add to it.

use super::context::Context;
use super::gesture::{Gesture, Next};
use super::overlay::Lit;
use crate::input::{Button, Pointer};
use crate::view::{Cursor, View};
use crate::workspace::Workspace;

/// The widget's step is open.
#[derive(Debug)]
pub(crate) struct Adjust;

impl Adjust {
    /// Opens the step.
    pub(crate) fn begin(workspace: &mut Workspace) -> Self {
        workspace.begin_adjusting();
        Self
    }
}

impl Gesture for Adjust {
    fn cursor(&self) -> Cursor {
        Cursor::Arrow
    }

    fn lit(&self) -> Lit {
        Lit::Gizmo(None)
    }

    fn status(&self, _: &Workspace, _: &View) -> Option<String> {
        None
    }

    fn pressed(&mut self, context: &mut Context<'_>, _: Pointer, _: Button) -> Next {
        context.workspace.commit_adjusting();
        Next::EndBefore
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        context.workspace.abort_adjusting();
    }
}
