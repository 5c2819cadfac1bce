//! Moving the camera while a button is held: orbit, or pan with Shift.

use glam::{DVec2, DVec3};

use super::context::Context;
use super::gesture::{Gesture, Next};
use super::overlay::Lit;
use crate::input::{Button, Pointer};
use crate::view::{Camera, Cursor, View};
use crate::workspace::Workspace;

/// The camera follows the pointer.
#[derive(Debug)]
pub(crate) struct Navigate {
    button: Button,
    way: Way,
    last_px: DVec2,
    before: Camera,
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Way {
    Orbit,
    /// Points at this one's depth stay under the pointer.
    Pan(DVec3),
}

impl Navigate {
    pub(super) fn begin(workspace: &Workspace, view: &View, pointer: Pointer, button: Button) -> Self {
        let way = if pointer.modifiers.shift {
            Way::Pan(workspace.anchor(view, pointer.position_px))
        } else {
            Way::Orbit
        };
        Self {
            button,
            way,
            last_px: pointer.position_px,
            before: *view.camera(),
        }
    }
}

impl Gesture for Navigate {
    fn cursor(&self) -> Cursor {
        Cursor::Grabbing
    }

    fn lit(&self) -> Lit {
        Lit::Gizmo(None)
    }

    fn status(&self, _: &Workspace, _: &View) -> Option<String> {
        let doing = match self.way {
            Way::Orbit => "Turning the view",
            Way::Pan(_) => "Moving the view",
        };
        Some(format!("{doing}: Esc to cancel"))
    }

    fn moves_camera(&self) -> bool {
        true
    }

    fn moved(&mut self, context: &mut Context<'_>, pointer: Pointer) -> Next {
        let delta_px = pointer.position_px - self.last_px;
        self.last_px = pointer.position_px;
        if delta_px != DVec2::ZERO {
            let (orbit, viewport_px) = (context.view.orbit(), context.view.viewport_px());
            context.view.travel(|camera| match self.way {
                Way::Orbit => camera.orbit(orbit, delta_px),
                Way::Pan(anchor) => camera.pan(delta_px, anchor, viewport_px),
            });
        }
        Next::Stay
    }

    fn released(&mut self, _: &mut Context<'_>, _: Pointer, button: Button) -> Next {
        if button == self.button { Next::End } else { Next::Stay }
    }

    fn pressed(&mut self, context: &mut Context<'_>, _: Pointer, button: Button) -> Next {
        if button == Button::Secondary && self.button != Button::Secondary {
            self.abort(context);
            return Next::End;
        }
        Next::Stay
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        context.view.adjust(|camera| *camera = self.before);
    }
}
