//! A number that is dragged or typed; Escape restores it.

use eframe::egui::{Response, Ui, response::Flags};

use crate::window::input::event_queue::EventQueue;

/// Shows the field or slider that `add` makes for a value. Build it with `update_while_editing(false)`: a typed number
/// counts when Enter or a click elsewhere ends the typing, and never after Escape.
///
/// egui keeps the text of a field for another frame after it has lost the focus, and would accept it then.
pub fn number_field<N: Copy>(ui: &mut Ui, value: &mut N, add: impl FnOnce(&mut Ui, &mut N) -> Response) -> Response {
    let before = *value;
    let mut response = add(ui, value);
    if EventQueue::has_escaped(ui.ctx()) && !response.dragged() {
        *value = before;
        response.flags.remove(Flags::CHANGED);
    }
    response
}
