//! The requests of panels and bars to the editor in a frame.

use eframe::egui::Response;
use pliant_editor::{Command, Event};

use crate::window::input::file_command::FileCommand;

/// Events for the editor, in order, and the request for files.
#[derive(Debug, Default)]
pub struct Outbox(Vec<Event>, Option<FileCommand>);

impl Outbox {
    /// Requests a command.
    pub fn push(&mut self, command: Command) {
        self.0.push(Event::Command(command));
    }

    /// Requests the value of a widget: during a drag every value is shown, and all of them make one step of the
    /// history.
    pub fn adjust(&mut self, response: &Response, command: impl FnOnce() -> Command) {
        if response.changed() {
            if response.dragged() || response.drag_stopped() {
                self.0.push(Event::Adjust(command()));
            } else {
                self.push(command());
            }
        }
        if response.drag_stopped() {
            self.0.push(Event::Adjusted);
        }
    }

    /// Requests a file command.
    pub fn push_file(&mut self, command: FileCommand) {
        self.1 = Some(command);
    }

    /// The requested file command.
    pub fn take_file(&mut self) -> Option<FileCommand> {
        self.1.take()
    }

    /// The events.
    pub fn take(self) -> Vec<Event> {
        self.0
    }
}
