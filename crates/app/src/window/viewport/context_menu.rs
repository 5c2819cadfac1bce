//! The menu of a right click: the commands for the part under the pointer.

use eframe::egui;
use glam::DVec2;
use pliant_editor::{Command, Editor, Handle, HandleId, ObjectAction, Paint, RegionAction, ToolMode};

use crate::window::widgets::command_button::{command_button, named_button};
use crate::window::widgets::outbox::Outbox;

/// The part of the surface that was clicked with the right button.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Clicked {
    /// A handle.
    Handle(HandleId),
    /// A painted region of this role.
    Region(Paint),
    /// The surface without paint.
    Bare,
    /// Nothing.
    Background,
}

/// Shows it where the view was clicked with the right button, until a click elsewhere closes it. A handle under the
/// click is selected, so that the commands apply to it. Returns the handle that the person wants to rename.
pub fn show(response: &egui::Response, editor: &Editor, commands: &mut Outbox) -> Option<HandleId> {
    let id = response.id.with("clicked");
    if response.secondary_clicked()
        && let Some(at) = response.interact_pointer_pos()
    {
        let clicked = clicked_at(editor, at - response.rect.min);
        response.ctx.data_mut(|data| data.insert_temp(id, clicked));
        if let Clicked::Handle(handle) = clicked {
            commands.push(Command::SelectHandle(handle));
        }
    }
    let clicked = response
        .ctx
        .data(|data| data.get_temp(id))
        .unwrap_or(Clicked::Background);
    let mut renamed = None;
    response.context_menu(|ui| {
        match clicked {
            Clicked::Handle(id) => {
                if let Some(handle) = editor.document().handle(id) {
                    of_handle(ui, editor, handle, commands, &mut renamed);
                }
            }
            Clicked::Region(role) => of_region(ui, editor, role, commands),
            Clicked::Bare => of_surface(ui, editor, commands),
            Clicked::Background => {}
        }
        buttons(ui, editor, &[Command::FrameAll, Command::ShowEverything], commands);
    });
    renamed
}

fn of_handle(
    ui: &mut egui::Ui,
    editor: &Editor,
    handle: &Handle,
    commands: &mut Outbox,
    renamed: &mut Option<HandleId>,
) {
    ui.label(egui::RichText::new(&handle.name).strong());
    buttons(ui, editor, &[Command::Move, Command::Turn, Command::Scale], commands);
    ui.separator();
    if ui.button("Rename").clicked() {
        *renamed = Some(handle.id);
        ui.close();
    }
    parent_menu(ui, editor, handle, commands);
    buttons(
        ui,
        editor,
        &[Command::PickPivot, Command::PinOrUnpin, Command::FrameSelected],
        commands,
    );
    ui.separator();
    buttons(
        ui,
        editor,
        &[
            Command::ResetHandle,
            Command::ResetRegion,
            Command::DuplicateHandle,
            Command::DeleteHandle,
        ],
        commands,
    );
    ui.separator();
    buttons(ui, editor, &[Command::NewHandle, Command::SelectAll], commands);
}

/// The handles with which this one may ride along.
fn parent_menu(ui: &mut egui::Ui, editor: &Editor, handle: &Handle, commands: &mut Outbox) {
    let others = editor.document().possible_parents(handle.id);
    let others: Vec<&Handle> = others.collect();
    ui.add_enabled_ui(!others.is_empty(), |ui| {
        ui.menu_button("Parent", |ui| {
            let choices = others.iter().map(|other| (Some(other.id), &*other.name));
            for (parent, name) in [(None, "none")].into_iter().chain(choices) {
                if ui.selectable_label(handle.parent == parent, name).clicked() {
                    commands.push(Command::SetParent(handle.id, parent));
                    ui.close();
                }
            }
        });
    });
}

fn of_region(ui: &mut egui::Ui, editor: &Editor, role: Paint, commands: &mut Outbox) {
    let (tool, name, other) = match role {
        Paint::Fixed => (ToolMode::PaintFixed, "Fixed part", RegionAction::ToFree),
        _ => (ToolMode::PaintFree, "Region", RegionAction::ToFixed),
    };
    ui.label(egui::RichText::new(name).strong());
    buttons(ui, editor, &[Command::SetTool(tool)], commands);
    ui.separator();
    for action in [
        RegionAction::ToHandle,
        other,
        RegionAction::Grow,
        RegionAction::Shrink,
        RegionAction::Clear,
    ] {
        let command = Command::RegionOf(role, action);
        if named_button(ui, editor, &command, &Command::Region(action)) {
            commands.push(command);
            ui.close();
        }
    }
    ui.separator();
    of_surface(ui, editor, commands);
}

fn of_surface(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    buttons(ui, editor, &[Command::NewHandle, Command::SelectAll], commands);
    ui.separator();
    let has_objects = editor.view().model.is_some_and(|model| model.all_objects().len() > 1);
    if has_objects {
        let objects = [ObjectAction::Hide, ObjectAction::Solo, ObjectAction::Lock].map(Command::ObjectHere);
        buttons(ui, editor, &objects, commands);
    }
    buttons(ui, editor, &[Command::FramePartHere, Command::Isolate], commands);
    ui.separator();
}

fn buttons(ui: &mut egui::Ui, editor: &Editor, listed: &[Command], commands: &mut Outbox) {
    for command in listed {
        if command_button(ui, editor, command) {
            commands.push(command.clone());
            ui.close();
        }
    }
}

/// The part under a point of the view.
fn clicked_at(editor: &Editor, at: egui::Vec2) -> Clicked {
    let Some(pick) = editor.pick(DVec2::new(f64::from(at.x), f64::from(at.y))) else {
        return Clicked::Background;
    };
    match editor.document().paint()[pick.vertex.index()] {
        Paint::Handle(id) => Clicked::Handle(id),
        role @ (Paint::Free | Paint::Fixed) => Clicked::Region(role),
        Paint::Bare => Clicked::Bare,
    }
}
