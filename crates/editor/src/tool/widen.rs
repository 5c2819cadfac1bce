//! Widening a handle's reach with the pointer: the farther from the handle, the farther the surface comes along.

use glam::DVec2;

use super::Tool;
use crate::document::Transaction;
use crate::document::{HandleId, Paint};
use crate::editor::Editor;
use crate::jobs::reach_length;
use crate::{Button, Key, Pointer, Reach};
use pliant_mesh::SurfaceVertex;

/// A reach that follows the pointer; a click keeps it.
#[derive(Debug)]
pub(crate) struct Widen {
    transaction: Transaction,
    handle: HandleId,
    start_length: f64,
    start_px: f64,
    centre_px: DVec2,
}

impl Widen {
    /// Begins with the selected handle; `None` if none is selected, or it is not in front of the eye.
    pub(crate) fn begin(editor: &mut Editor) -> Option<Self> {
        let handle = editor.document.handle(editor.selected?)?.clone();
        let model = editor.engine.model.clone()?;
        let members: Vec<SurfaceVertex> = (0..editor.document.paint.len() as u32)
            .map(SurfaceVertex)
            .filter(|vertex| editor.document.paint[vertex.index()] == Paint::Handle(handle.id))
            .collect();
        let start_length = reach_length(handle.reach, &model.surface, &model.topology, &members);
        let centre_px = editor.camera.project(handle.centre(), editor.viewport_px)?;
        let pointer_px = editor
            .pointer
            .map_or(centre_px + DVec2::X * 60.0, |pointer| pointer.position_px);
        // What lies on the screen under the pointer is where the reach begins to be measured.
        let px = editor.camera.world_per_px(handle.centre(), editor.viewport_px);
        let transaction = editor.begin(format!("Reach of {}", handle.name));
        Some(Self {
            transaction,
            handle: handle.id,
            start_length: start_length.max(px),
            start_px: pointer_px.distance(centre_px).max(8.0),
            centre_px,
        })
    }

    pub(crate) fn moved(self, editor: &mut Editor, pointer: Pointer) -> Tool {
        let factor = pointer.position_px.distance(self.centre_px).max(1.0) / self.start_px;
        let reach = Reach::Length(self.start_length * factor);
        if editor
            .document
            .handle(self.handle)
            .is_some_and(|handle| handle.reach != reach)
        {
            editor.engine.drop_solves();
            editor.document.apply_shape();
            if let Some(handle) = editor.document.handle_mut(self.handle) {
                handle.reach = reach;
            }
        }
        Tool::Widen(Box::new(self))
    }

    pub(crate) fn pressed(self, editor: &mut Editor, pointer: Pointer, button: Button) -> Tool {
        match button {
            Button::Primary => {
                if let Tool::Widen(widen) = self.moved(editor, pointer) {
                    widen.transaction.commit(&editor.document, &mut editor.history);
                }
                Tool::Idle
            }
            Button::Secondary => {
                self.abort(editor);
                Tool::Idle
            }
            Button::Middle => Tool::Widen(Box::new(self)),
        }
    }

    pub(crate) fn key(self, editor: &mut Editor, key: Key) -> Tool {
        match key {
            Key::Escape => {
                self.abort(editor);
                Tool::Idle
            }
            Key::Enter => {
                self.transaction.commit(&editor.document, &mut editor.history);
                Tool::Idle
            }
            _ => Tool::Widen(Box::new(self)),
        }
    }

    pub(crate) fn abort(self, editor: &mut Editor) {
        self.transaction.abort(&mut editor.document);
        editor.engine.drop_solves();
    }

    pub(crate) fn status(&self, editor: &Editor) -> String {
        let length = match editor.document.handle(self.handle).map(|handle| handle.reach) {
            Some(Reach::Length(length)) => length,
            _ => self.start_length,
        };
        format!("Reach {length:.4}: move away from the handle to widen it, click to keep it, Esc to leave it")
    }
}
