//! The panel beside the view: the bending of the surface, and beneath it a page with handles, with the method's options,
//! or with objects, history and file.

mod bend;
mod crease;
mod examples;
pub(in crate::window) mod file;
pub(in crate::window) mod handles;
pub(in crate::window) mod history;
mod intersections;
pub(in crate::window) mod loose;
mod material;
pub(in crate::window) mod method;
mod method_picture;
pub(in crate::window) mod notes;
pub(in crate::window) mod objects;
mod part_name;
mod poses;
mod strength;
mod title;
mod weld;

use std::collections::BTreeSet;

use eframe::egui;
use eframe::egui::ScrollArea;
use pliant_editor::{Command, Editor};

use crate::window::files::settings::{PanelPage, Settings};
use crate::window::widgets::command_button::command_button;
use crate::window::widgets::outbox::Outbox;
use notes::Notes;

/// A change of the panel's own state.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum PanelChange {
    /// Another page is chosen.
    Page(PanelPage),
    /// The section with this title was folded away or unfolded.
    Folded(&'static str),
}

const PAGES: [(PanelPage, &str, &str); 3] = [
    (PanelPage::Handles, "Handles", "Shows the handles and the kept poses."),
    (
        PanelPage::Method,
        "Method",
        "Shows the method's options, examples, cage or lattice, and the treatment of loose parts.",
    ),
    (
        PanelPage::Scene,
        "Scene",
        "Shows the objects, the history and the file.",
    ),
];

/// Shows the panel: the bending, which stays in place, and a page beneath it. Commands for the editor are added to
/// `commands`.
pub fn show(
    ui: &mut egui::Ui,
    editor: &Editor,
    notes: &Notes,
    morph_targets: &[String],
    settings: &Settings,
    commands: &mut Outbox,
) -> Option<PanelChange> {
    ui.add_space(6.0);
    bending(ui, editor, commands);
    ui.add_space(2.0);
    let mut change = tabs(ui, settings.page).map(PanelChange::Page);
    ui.separator();
    let mut section = |ui: &mut egui::Ui, title, contents: &mut dyn FnMut(&mut egui::Ui)| {
        if section(ui, title, &settings.folded, contents) {
            change = Some(PanelChange::Folded(title));
        }
    };
    warnings(ui, editor, commands);
    let scrolled = ScrollArea::vertical().id_salt(settings.page as u8).auto_shrink(false);
    scrolled.show(ui, |ui| match settings.page {
        PanelPage::Handles => {
            handles::show(ui, editor, commands);
            ui.separator();
            if editor.document().poses().is_empty() {
                poses::show_none(ui, editor, commands);
            } else {
                section(ui, "Poses", &mut |ui| poses::show(ui, editor, commands));
            }
        }
        PanelPage::Method => {
            method::show_options(ui, editor, morph_targets, commands);
            ui.separator();
            loose::show(ui, editor, commands);
        }
        PanelPage::Scene => {
            section(ui, "Objects", &mut |ui| objects::show(ui, editor, commands));
            section(ui, "History", &mut |ui| history::show(ui, editor, commands));
            section(ui, "File", &mut |ui| file::show(ui, editor, notes, commands));
        }
    });
    change
}

/// The names of the pages; returns the one that is clicked.
fn tabs(ui: &mut egui::Ui, shown: PanelPage) -> Option<PanelPage> {
    let width = (ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / PAGES.len() as f32;
    let mut chosen = None;
    ui.horizontal(|ui| {
        for (page, name, meaning) in PAGES {
            let tab = egui::Button::selectable(page == shown, name).min_size(egui::vec2(width, 0.0));
            let tab = ui.add(tab).on_hover_text(meaning);
            tab.widget_info(|| egui::WidgetInfo::selected(egui::Role::Tab, true, page == shown, name));
            if tab.clicked() {
                chosen = Some(page);
            }
        }
    });
    chosen
}

/// A part of the panel that can be folded; true if it was folded or unfolded just now.
fn section(ui: &mut egui::Ui, title: &str, folded: &BTreeSet<String>, contents: &mut dyn FnMut(&mut egui::Ui)) -> bool {
    let header = egui::CollapsingHeader::new(title::title(title))
        .id_salt(title)
        .default_open(!folded.contains(title))
        .show_unindented(ui, |ui| {
            ui.add_space(2.0);
            contents(ui);
        });
    ui.add_space(2.0);
    ui.separator();
    header.header_response.clicked()
}

/// Shows the warnings about the edit at the panel's lower end, where they move nothing that a person is about to click.
fn warnings(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let (warnings, faults) = (editor.warnings(), editor.faults());
    // It is there without warnings, too: a field keeps the focus only while nothing is added before it.
    let lower = egui::Panel::bottom("warnings")
        .resizable(false)
        .show_separator_line(false);
    lower.frame(egui::Frame::NONE).show(ui, |ui| {
        if warnings.is_empty() && faults.is_empty() {
            return;
        }
        ui.separator();
        let room = ScrollArea::vertical()
            .min_scrolled_height(WARNINGS)
            .max_height(WARNINGS);
        room.show(ui, |ui| {
            intersections::show(ui, editor, &faults, commands);
            for sentence in warnings {
                let colour = ui.visuals().warn_fg_color;
                ui.add(egui::Label::new(egui::RichText::new(sentence).small().color(colour)).wrap());
            }
        });
    });
}

/// The most room for warnings, in points.
const WARNINGS: f32 = 220.0;

/// The method, and the edit as a whole.
fn bending(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    method::show(ui, editor, commands);
    strength::show(ui, editor, commands);
    ui.horizontal_wrapped(|ui| {
        for command in [Command::Apply, Command::ResetShape, Command::ClearRegions] {
            if command_button(ui, editor, &command) {
                commands.push(command);
            }
        }
    });
}
