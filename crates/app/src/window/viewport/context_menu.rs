//! The menu of a right click: the commands for the part under the pointer.

use eframe::egui;
use glam::DVec2;
use pliant_editor::{Command, Editor, HandleId, Paint};

use crate::window::widgets::command_button::command_button;
use crate::window::widgets::outbox::Outbox;

/// Shows it where the view was clicked with the right button, until a click elsewhere closes it. A handle under the
/// click is selected, so that the menu applies to it.
pub fn show(response: &egui::Response, editor: &Editor, commands: &mut Outbox) {
    if response.secondary_clicked()
        && let Some(at) = response.interact_pointer_pos()
        && let Some(handle) = handle_at(editor, at - response.rect.min)
    {
        commands.push(Command::SelectHandle(handle));
    }
    response.context_menu(|ui| {
        let view = editor.view();
        let of_handle: &[Command] = &[
            Command::Move,
            Command::Turn,
            Command::Scale,
            Command::ResetHandle,
            Command::PickPivot,
            Command::PinOrUnpin,
            Command::FrameSelected,
            Command::DeleteHandle,
        ];
        let of_surface: &[Command] = &[Command::NewHandle, Command::SelectAll];
        let groups = match view.selected {
            Some(_) => [of_handle, of_surface],
            None => [of_surface, &[]],
        };
        for command in groups.concat().iter().chain(&[Command::FrameAll]) {
            if command_button(ui, editor, command) {
                commands.push(command.clone());
                ui.close();
            }
        }
    });
}

/// The handle under a point of the view.
fn handle_at(editor: &Editor, at: egui::Vec2) -> Option<HandleId> {
    let pick = editor.pick(DVec2::new(f64::from(at.x), f64::from(at.y)))?;
    match editor.document().paint()[pick.vertex.index()] {
        Paint::Handle(id) => Some(id),
        _ => None,
    }
}
