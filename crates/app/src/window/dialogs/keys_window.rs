//! The list of commands and their keys. A person changes a key by pressing another.

use eframe::egui::{self, RichText, ScrollArea};
use pliant_editor::{Command, Editor, Key, Listed, Shortcut};

use super::palette::is_named;
use crate::window::bars::status;
use crate::window::files::settings::SettingsFile;
use crate::window::input::own_keys;

/// egui's id of its window.
pub const ID: &str = "keys window";

/// The width of the names, in points.
const NAME_WIDTH: f32 = 210.0;

/// The open list.
#[derive(Debug, Default)]
pub struct KeysWindow {
    /// True if it is open.
    pub open: bool,
    /// The command that waits for its key.
    waiting: Option<&'static str>,
    /// The typed part of a name, or a key.
    sought: String,
    /// The reason why the last key was not taken.
    refusal: Option<String>,
}

impl KeysWindow {
    /// Returns true if the next key is meant for it.
    pub fn takes_keys(&self) -> bool {
        self.open && self.waiting.is_some()
    }

    /// Shows the list, if it is open; true when a key was changed.
    pub fn show(&mut self, context: &egui::Context, editor: &Editor, settings: &mut SettingsFile) -> bool {
        let mut changed = false;
        if let Some(name) = self.waiting
            && let Some(key) = context.input(own_keys::pressed)
        {
            let allowed = key.and_then(|key| own_keys::refusal(key, name).map_or(Ok(key), Err));
            match allowed {
                // It waits for another key.
                Err(refusal) => self.refusal = Some(refusal),
                Ok(key) => {
                    (self.waiting, self.refusal) = (None, None);
                    // Escape changes nothing.
                    if key.key != Key::Escape {
                        give(key, name, editor, settings);
                        changed = true;
                    }
                }
            }
        }
        let mut open = self.open;
        egui::Window::new("Keys")
            .id(egui::Id::unique(ID))
            .open(&mut open)
            .default_width(360.0)
            .show(context, |ui| {
                let others = !settings.get().keys.is_empty();
                if ui.add_enabled(others, egui::Button::new("Default keys")).clicked() {
                    settings.change(|settings| settings.keys.clear());
                    changed = true;
                }
                if let Some(refusal) = &self.refusal {
                    ui.label(RichText::new(refusal).color(status::failed(ui)));
                }
                let sought = egui::TextEdit::singleline(&mut self.sought)
                    .hint_text("Search by name or key")
                    .desired_width(f32::INFINITY);
                let sought = ui.add(sought);
                sought.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Search keys"));
                ui.separator();
                ScrollArea::vertical()
                    .max_height(380.0)
                    .auto_shrink(false)
                    .show(ui, |ui| self.list(ui, editor));
            });
        self.open = open;
        if !open {
            self.waiting = None;
            self.refusal = None;
        }
        changed
    }
}

impl KeysWindow {
    /// The sought commands with their keys, group by group.
    fn list(&mut self, ui: &mut egui::Ui, editor: &Editor) {
        let typed = self.sought.trim().to_lowercase();
        let is_sought = |listed: &&Listed| {
            let keys = editor.shortcuts(&listed.command);
            let has_key = !typed.is_empty() && keys.iter().any(|key| key.label().to_lowercase() == typed);
            has_key || is_named(&listed.name.to_lowercase(), listed.keywords, &typed)
        };
        let found: Vec<&Listed> = Command::all_listed().filter(is_sought).collect();
        if found.is_empty() {
            ui.label(RichText::new("No command has this name or key.").weak());
        }
        let mut groups: Vec<&str> = Vec::new();
        for listed in &found {
            if !groups.contains(&listed.group) {
                groups.push(listed.group);
            }
        }
        for group in groups {
            ui.add_space(4.0);
            ui.label(RichText::new(group).strong());
            egui::Grid::new(("keys", group))
                .num_columns(2)
                .striped(true)
                .show(ui, |ui| {
                    for listed in found.iter().filter(|listed| listed.group == group) {
                        self.row(ui, editor, listed);
                    }
                });
        }
    }

    fn row(&mut self, ui: &mut egui::Ui, editor: &Editor, listed: &Listed) {
        ui.add_sized(
            [NAME_WIDTH, ui.spacing().interact_size.y],
            egui::Label::new(listed.name).truncate(),
        )
        .on_hover_text(listed.tooltip);
        let keys = editor.shortcuts(&listed.command);
        let shown = match (self.waiting == Some(listed.name), keys.first()) {
            (true, _) => "press a key".to_owned(),
            (false, Some(key)) => key.label(),
            (false, None) => "none".to_owned(),
        };
        let button = ui.button(RichText::new(shown).monospace());
        let label = format!("Key for {}", listed.name);
        button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
        if button.clicked() {
            self.waiting = Some(listed.name);
            self.refusal = None;
        }
        ui.end_row();
    }
}

/// Gives a key to the command of this name, and takes it from any other: a key sends one command.
fn give(key: Shortcut, name: &str, editor: &Editor, settings: &mut SettingsFile) {
    let others = Command::all_listed().filter(|listed| listed.name != name);
    let robbed: Vec<(String, Vec<String>)> = others
        .filter(|listed| editor.shortcuts(&listed.command).contains(&key))
        .map(|listed| {
            let left = editor.shortcuts(&listed.command).iter().filter(|other| **other != key);
            (listed.name.to_owned(), left.map(Shortcut::label).collect())
        })
        .collect();
    settings.change(|settings| {
        settings.keys.extend(robbed);
        settings.keys.insert(name.to_owned(), vec![key.label()]);
    });
}
