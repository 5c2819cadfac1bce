//! The poses that a person keeps: a list, each to be taken, renewed, renamed or removed.

use eframe::egui;
use pliant_editor::{Command, Editor};

use crate::window::widgets::command_button::{command_button, command_choice};
use crate::window::widgets::name_label::name_label;
use crate::window::widgets::outbox::Outbox;

/// Shows the title and the button that keeps the first pose, on a line.
pub fn show_none(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    ui.horizontal(|ui| {
        // Under the titles of the sections that fold.
        ui.add_space(ui.spacing().indent);
        ui.label(super::title::title("Poses"));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            keep(ui, editor, commands);
        });
    });
    ui.separator();
}

/// Shows the list; the pose that is shown is marked.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    for (place, pose) in editor.document().poses().iter().enumerate() {
        ui.push_id(("pose", place), |ui| {
            ui.horizontal(|ui| {
                let is_shown = editor.document().is_in_pose(pose);
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    let mut button = |verb: &str, says: &str, is_enabled: bool, command: Command| {
                        let button = ui.add_enabled(is_enabled, egui::Button::new(verb).small());
                        let name = format!("{verb} {}", pose.name);
                        button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, is_enabled, &name));
                        if button.on_hover_text(says).clicked() {
                            commands.push(command);
                        }
                    };
                    button(
                        "Remove",
                        "Deletes this pose. The shape stays.",
                        true,
                        Command::RemovePose(place),
                    );
                    let says = "Replaces this pose with the present one.";
                    button("Update", says, !is_shown, Command::RenewPose(place));
                    let says = "Moves everything back to this pose. Locked handles and pins stay.";
                    button("Apply", says, !is_shown, Command::TakePose(place));
                    if editor.view().look.timeline {
                        let command = Command::KeyPose(place);
                        let says = "Sets a key with this pose at the shown moment.";
                        button("Key", says, editor.is_enabled(&command), command);
                    }
                    // The name has the room that the buttons leave.
                    ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                        let (label, renamed) = name_label(ui, "the pose", place, &pose.name, is_shown);
                        label.on_hover_text(format!("{}: double-click to rename.", pose.name));
                        if let Some(name) = renamed {
                            commands.push(Command::RenamePose(place, name));
                        }
                    });
                });
            });
        });
    }
    keep(ui, editor, commands);
}

fn keep(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    ui.horizontal(|ui| {
        if command_button(ui, editor, &Command::KeepPose) {
            commands.push(Command::KeepPose);
        }
        if command_choice(ui, editor, &Command::WorkPose, editor.document().is_in_work_pose()) {
            commands.push(Command::WorkPose);
        }
    });
}
