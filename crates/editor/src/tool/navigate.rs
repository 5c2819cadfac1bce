//! Moving the camera while a button is held: orbit, or pan with Shift.

use glam::{DVec2, DVec3};

use super::Tool;
use crate::editor::Editor;
use crate::view::Camera;
use crate::{Button, Pointer};

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
    /// What is at this point's depth stays under the pointer.
    Pan(DVec3),
}

impl Navigate {
    pub(crate) fn begin(editor: &Editor, pointer: Pointer, button: Button) -> Self {
        let way = if pointer.modifiers.shift {
            Way::Pan(editor.anchor(pointer.position_px))
        } else {
            Way::Orbit
        };
        Self {
            button,
            way,
            last_px: pointer.position_px,
            before: editor.camera,
        }
    }

    pub(crate) fn moved(mut self, editor: &mut Editor, pointer: Pointer) -> Tool {
        let delta_px = pointer.position_px - self.last_px;
        self.last_px = pointer.position_px;
        match self.way {
            Way::Orbit => editor.camera.orbit(editor.orbit, delta_px),
            Way::Pan(anchor) => editor.camera.pan(delta_px, anchor, editor.viewport_px),
        }
        editor.is_framed &= delta_px == DVec2::ZERO;
        Tool::Navigate(self)
    }

    pub(crate) fn released(self, button: Button) -> Tool {
        if button == self.button {
            Tool::Idle
        } else {
            Tool::Navigate(self)
        }
    }

    pub(crate) fn abort(self, editor: &mut Editor) {
        editor.camera = self.before;
    }

    pub(crate) fn status(&self) -> &'static str {
        match self.way {
            Way::Orbit => "Turning the view",
            Way::Pan(_) => "Moving the view",
        }
    }
}
