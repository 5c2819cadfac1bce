//! How parts are merged: how far from their borders they bend, by which method, and where the part goes first.

use eframe::egui::{self, ComboBox, Slider};
use pliant_deform::{METHODS, Method};
use pliant_editor::{Command, Editor, MergeSettings, Placement, REACH_RANGE};

use crate::window::widgets::command_button::command_button;
use crate::window::widgets::row_label::row_label;

/// egui's id of its window.
pub const ID: &str = "merge window";

/// The window.
#[derive(Debug, Default)]
pub struct MergeWindow {
    /// True if it is open.
    pub open: bool,
}

impl MergeWindow {
    /// Shows the window, if it is open; returns the change of the settings, or the merge that a person asks for.
    pub fn show(&mut self, context: &egui::Context, editor: &Editor) -> Option<Command> {
        let before = editor.view().merge;
        let (mut settings, mut asked) = (before.clone(), None);
        egui::Window::new("Merge")
            .id(egui::Id::unique(ID))
            .open(&mut self.open)
            .default_width(320.0)
            .resizable(false)
            .show(context, |ui| {
                choose(ui, &mut settings);
                ui.horizontal(|ui| {
                    for command in [Command::Merge, Command::MergePairs] {
                        if command_button(ui, editor, &command) {
                            asked = Some(command);
                        }
                    }
                });
            });
        match settings != *before {
            true => Some(Command::SetMerge(settings)),
            false => asked,
        }
    }
}

fn choose(ui: &mut egui::Ui, settings: &mut MergeSettings) {
    ui.horizontal(|ui| {
        let name = row_label(ui, "Reach");
        let reach = Slider::new(&mut settings.reach, REACH_RANGE).logarithmic(true);
        ui.add(reach)
            .labelled_by(name.id)
            .on_hover_text("The distance from the borders within which each part bends, as a share of its diagonal.");
    });
    ui.horizontal(|ui| {
        row_label(ui, "Method");
        ComboBox::from_id_salt("merge method")
            .selected_text(settings.method.declaration().title)
            .height(640.0)
            .show_ui(ui, |ui| {
                for declaration in METHODS {
                    let is_present = settings.method.name() == declaration.name;
                    if ui.selectable_label(is_present, declaration.title).clicked()
                        && !is_present
                        && let Some(method) = Method::from_name(declaration.name)
                    {
                        settings.method = method;
                    }
                }
            });
    });
    let mut is_fitted = settings.placement == Placement::Fitted;
    if ui
        .checkbox(&mut is_fitted, "Move the part so that its border fits")
        .changed()
    {
        settings.placement = if is_fitted { Placement::Fitted } else { Placement::Kept };
    }
}
