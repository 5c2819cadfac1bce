//! A widget that is being dragged: whatever its commands change is shown at once and becomes one step at the end.

use super::Tool;
use crate::Command;
use crate::document::Transaction;
use crate::editor::Editor;

/// The step that the widget's commands make.
#[derive(Debug)]
pub(crate) struct Adjust(Transaction);

impl Adjust {
    pub(crate) fn commit(self, editor: &mut Editor) {
        self.0.commit(&editor.document, &mut editor.history);
    }

    pub(crate) fn abort(self, editor: &mut Editor) {
        self.0.abort(&mut editor.document);
        editor.engine.drop_solves();
        editor.repainted = true;
    }
}

impl Editor {
    /// Adds a command to the step that is being adjusted; the first begins it.
    pub(crate) fn adjust(&mut self, command: Command) {
        // Steps and gestures of their own have no place within a step.
        if matches!(
            command,
            Command::Undo | Command::Redo | Command::Move | Command::Turn | Command::Scale
        ) {
            return;
        }
        let step = match std::mem::take(&mut self.tool) {
            Tool::Adjust(adjust) => adjust.0,
            other => {
                other.abort(self);
                self.begin("Adjust")
            }
        };
        self.open_step = Some(step);
        self.execute(command);
        if let Some(step) = self.open_step.take() {
            self.tool = Tool::Adjust(Box::new(Adjust(step)));
        }
    }

    /// Ends the step.
    pub(crate) fn adjusted(&mut self) {
        match std::mem::take(&mut self.tool) {
            Tool::Adjust(adjust) => adjust.commit(self),
            other => self.tool = other,
        }
    }
}
