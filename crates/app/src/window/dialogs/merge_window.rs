//! How parts are merged: how far from their borders they bend, by which method, and where the part goes first.

use eframe::egui::{self, ComboBox, RichText, Slider};
use pliant_deform::{METHODS, Method};
use pliant_editor::{Editor, MergeSettings, Placement, REACH_RANGE};

/// egui's id of its window.
pub const ID: &str = "merge window";

/// The window.
#[derive(Debug, Default)]
pub struct MergeWindow {
    /// True if it is open.
    pub open: bool,
}

impl MergeWindow {
    /// Shows the window, if it is open; the settings when they change.
    pub fn show(&mut self, context: &egui::Context, editor: &Editor) -> Option<MergeSettings> {
        let before = editor.view().merge;
        let mut settings = before.clone();
        egui::Window::new("Merge")
            .id(egui::Id::unique(ID))
            .open(&mut self.open)
            .default_width(320.0)
            .resizable(false)
            .show(context, |ui| choose(ui, &mut settings));
        (settings != *before).then_some(settings)
    }
}

fn choose(ui: &mut egui::Ui, settings: &mut MergeSettings) {
    let reach = Slider::new(&mut settings.reach, REACH_RANGE)
        .logarithmic(true)
        .text("Reach");
    ui.add(reach)
        .on_hover_text("The distance from the borders within which each part bends, as a share of its diagonal.");
    ComboBox::new("merge method", "Method")
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
    let mut is_fitted = settings.placement == Placement::Fitted;
    if ui
        .checkbox(&mut is_fitted, "Move the part so that its border fits")
        .changed()
    {
        settings.placement = if is_fitted { Placement::Fitted } else { Placement::Kept };
    }
    let note = "Choose Merge nearest borders or Merge two borders in the menu Mesh.";
    ui.label(RichText::new(note).weak().small());
}
