//! The requests of panels and bars to the editor in a frame.

use eframe::egui::Response;
use pliant_editor::{Command, Event};

/// Events for the editor, in order.
#[derive(Debug, Default)]
pub struct Outbox(Vec<Event>);

impl Outbox {
    /// Asks for a command.
    pub fn push(&mut self, command: Command) {
        self.0.push(Event::Command(command));
    }

    /// Requests the value of a widget: while it is dragged every value is shown, and all of them make one step of the
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

    /// The events.
    pub fn take(self) -> Vec<Event> {
        self.0
    }
}
