//! Widening a handle's reach with the pointer: a larger distance from the handle is a larger reach.

use glam::DVec2;

use super::context::Context;
use super::gesture::{Gesture, Next};
use super::overlay::Lit;
use crate::document::{HandleId, Reach, Transaction};
use crate::input::{Button, Key, Modifiers, Pointer};
use crate::view::{Cursor, View};
use crate::workspace::Workspace;

/// A reach that follows the pointer; a click keeps it.
#[derive(Debug)]
pub(crate) struct Widen {
    transaction: Transaction,
    handle: HandleId,
    start_length: f64,
    /// The reach of a length, of the same kind as it was at the beginning.
    make: fn(f64) -> Reach,
    start_px: f64,
    centre_px: DVec2,
}

impl Widen {
    /// Begins with the selected handle; `None` if none is selected, or it is not in front of the eye.
    pub(crate) fn begin(workspace: &mut Workspace, view: &View, pointer: Option<Pointer>) -> Option<Self> {
        let handle = workspace.selected()?.clone();
        let start_length = match handle.reach {
            Reach::Bounded(length) | Reach::Creased(length) | Reach::Length(length) => length,
            Reach::Found | Reach::Feature | Reach::Part | Reach::Radii(_) => {
                workspace.computed().region.reach_length(handle.id).unwrap_or(0.0)
            }
        };
        let (camera, viewport_px) = (view.camera(), view.viewport_px());
        let centre_px = camera.project(handle.centre(), viewport_px)?;
        let pointer_px = pointer.map_or(centre_px + DVec2::X * 60.0, |pointer| pointer.position_px);
        // The reach is measured from the point under the pointer on the screen.
        let px = camera.world_per_px(handle.centre(), viewport_px);
        Some(Self {
            transaction: workspace.begin(format!("Reach of {}", handle.name)),
            handle: handle.id,
            start_length: start_length.max(px),
            make: match handle.reach {
                Reach::Found | Reach::Bounded(_) => Reach::Bounded,
                Reach::Feature | Reach::Creased(_) => Reach::Creased,
                Reach::Part | Reach::Radii(_) | Reach::Length(_) => Reach::Length,
            },
            start_px: pointer_px.distance(centre_px).max(8.0),
            centre_px,
        })
    }
}

impl Gesture for Widen {
    fn cursor(&self) -> Cursor {
        Cursor::Move
    }

    fn lit(&self) -> Lit {
        Lit::Gizmo(None)
    }

    fn status(&self, workspace: &Workspace, _: &View) -> Option<String> {
        let length = match workspace.document.handle(self.handle).map(|handle| handle.reach) {
            Some(Reach::Bounded(length) | Reach::Creased(length) | Reach::Length(length)) => length,
            _ => self.start_length,
        };
        Some(format!(
            "Reach {length:.4}: move away from the handle to widen it, click to keep it, Esc to cancel"
        ))
    }

    fn moved(&mut self, context: &mut Context<'_>, pointer: Pointer) -> Next {
        let factor = pointer.position_px.distance(self.centre_px).max(1.0) / self.start_px;
        let reach = (self.make)(self.start_length * factor);
        let workspace = &mut *context.workspace;
        if workspace
            .document
            .handle(self.handle)
            .is_some_and(|handle| handle.reach != reach)
        {
            workspace.jobs.drop_solves();
            workspace.document.keep_shape();
            workspace
                .document
                .change_handle(self.handle, |handle| handle.reach = reach);
        }
        Next::Stay
    }

    fn pressed(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        match button {
            Button::Primary => {
                self.moved(context, pointer);
                context.workspace.commit(&self.transaction);
            }
            Button::Secondary => self.abort(context),
            Button::Middle => return Next::Stay,
        }
        Next::End
    }

    fn key(&mut self, context: &mut Context<'_>, key: Key, _: Modifiers) -> Option<Next> {
        match key {
            Key::Escape => self.abort(context),
            Key::Enter => {
                context.workspace.commit(&self.transaction);
            }
            _ => return Some(Next::Stay),
        }
        Some(Next::End)
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        context.workspace.abort(&self.transaction);
    }
}
