//! The command palette: every command by its name, found by typing a part of it.

use std::borrow::Cow;

use eframe::egui::{self, Id, Key, Modal, RichText, ScrollArea};
use pliant_deform::METHODS;
use pliant_editor::{Command, Editor};

use crate::window::bars::status;
use crate::window::input::file_command::FileCommand;

/// The open palette.
#[derive(Debug, Default)]
pub struct Palette {
    typed: String,
    chosen: usize,
    /// The reason why the last request can't be done now.
    refusal: Option<String>,
}

/// An entry of the palette.
#[derive(Clone, Debug)]
pub enum Found {
    /// A command of the editor.
    Editor(Command),
    /// A command of the window.
    File(FileCommand),
}

/// The result of a frame of the palette.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// It stays open.
    Open,
    /// It closes, and the command of this name follows.
    Chosen(Option<(String, Found)>),
}

struct Entry {
    name: String,
    tooltip: String,
    keywords: &'static str,
    shortcut: String,
    found: Found,
    /// The reason why it can't be done now.
    obstacle: Option<String>,
}

impl Palette {
    /// Shows it over everything. `recent` has the names that were chosen before, the newest first.
    pub fn show(&mut self, context: &egui::Context, editor: &Editor, recent: &[String]) -> Outcome {
        let mut outcome = Outcome::Open;
        let modal = Modal::new(Id::unique("palette")).show(context, |ui| {
            ui.set_width(440.0);
            let (up, down, enter) = ui.input(|input| {
                (
                    input.key_pressed(Key::ArrowUp),
                    input.key_pressed(Key::ArrowDown),
                    input.key_pressed(Key::Enter),
                )
            });
            // It has the keyboard from the first frame on, so that fast typing loses no letter.
            let id = ui.scope_id().with("typed");
            ui.memory_mut(|memory| memory.request_focus(id));
            let field = egui::TextEdit::singleline(&mut self.typed)
                .id(id)
                .hint_text("Type a command")
                .desired_width(f32::INFINITY);
            let field = ui.add(field);
            field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Command"));
            if field.changed() {
                self.chosen = 0;
            }
            if field.changed() || up || down {
                self.refusal = None;
            }
            let entries = entries(context, editor, &self.typed, recent);
            self.chosen = (self.chosen + usize::from(down))
                .saturating_sub(usize::from(up))
                .min(entries.len().saturating_sub(1));
            ui.add_space(4.0);
            if let Some(refusal) = &self.refusal {
                ui.add(egui::Label::new(RichText::new(refusal).color(status::failed(ui))).wrap());
            }
            ScrollArea::vertical()
                .max_height(320.0)
                .auto_shrink(false)
                .show(ui, |ui| {
                    if entries.is_empty() {
                        ui.label(RichText::new("No command has this name.").weak());
                    }
                    for (number, entry) in entries.iter().enumerate() {
                        let shortcut = RichText::new(&entry.shortcut);
                        let shortcut = match number == self.chosen {
                            // Weak text has too little contrast on the chosen row.
                            true => shortcut,
                            false => shortcut.weak(),
                        };
                        let button = egui::Button::selectable(number == self.chosen, &entry.name)
                            .right_text(shortcut)
                            .min_size(egui::vec2(ui.available_width(), 0.0));
                        let button = ui.add_enabled(entry.obstacle.is_none(), button);
                        let button = button
                            .on_hover_text(&entry.tooltip)
                            .on_disabled_hover_text(entry.obstacle.as_deref().unwrap_or_default());
                        if number == self.chosen && (up || down) {
                            button.scroll_to_me(None);
                        }
                        // A disabled button is never clicked for egui.
                        let is_pointed_at =
                            button.contains_pointer() && ui.input(|input| input.pointer.primary_clicked());
                        if is_pointed_at || button.clicked() || (enter && number == self.chosen) {
                            match &entry.obstacle {
                                None => outcome = Outcome::Chosen(Some((entry.name.clone(), entry.found.clone()))),
                                Some(obstacle) => {
                                    self.refusal = Some(obstacle.clone());
                                    // This is above the list, whose place this frame has already passed.
                                    ui.ctx().request_repaint();
                                }
                            }
                        }
                    }
                });
        });
        match outcome {
            Outcome::Open if modal.should_close() => Outcome::Chosen(None),
            outcome => outcome,
        }
    }
}

/// The matches, the best first: names that begin with the typed text, then names that contain it, then entries whose
/// keywords contain it, then names with its letters in order. Among equal matches, those that can be done now come
/// first, and of these the recent ones.
fn entries(context: &egui::Context, editor: &Editor, typed: &str, recent: &[String]) -> Vec<Entry> {
    let typed = typed.trim().to_lowercase();
    let listed = Command::all_listed().map(|listed| Entry {
        name: listed.name.to_owned(),
        tooltip: listed.tooltip.to_owned(),
        keywords: listed.keywords,
        shortcut: editor
            .shortcuts(&listed.command)
            .first()
            .map(|s| s.label())
            .unwrap_or_default(),
        found: Found::Editor(listed.command.clone()),
        obstacle: editor.unavailable_because(&listed.command).map(Cow::into_owned),
    });
    let files = FileCommand::LISTED.iter().map(|command| Entry {
        name: command.name().trim_end_matches('…').to_owned(),
        tooltip: String::new(),
        keywords: command.keywords(),
        shortcut: command
            .shortcut()
            .map(|shortcut| context.format_shortcut(&shortcut))
            .unwrap_or_default(),
        found: Found::File(command.clone()),
        obstacle: command.unavailable_because(editor).map(str::to_owned),
    });
    let methods = METHODS.iter().map(|declaration| {
        let command = Command::SetMethod((declaration.first_choice)());
        Entry {
            name: format!("Method: {}", declaration.title),
            tooltip: declaration.explanation(),
            keywords: declaration.keywords,
            shortcut: String::new(),
            obstacle: match editor.document().method().name() == declaration.name {
                true => Some("This method is already in use.".to_owned()),
                false => editor.unavailable_because(&command).map(Cow::into_owned),
            },
            found: Found::Editor(command),
        }
    });
    let mut found: Vec<(u8, Entry)> = listed
        .chain(methods)
        .chain(files)
        .filter_map(|entry| Some((rank(&entry.name.to_lowercase(), entry.keywords, &typed)?, entry)))
        .collect();
    let age = |entry: &Entry| {
        recent
            .iter()
            .position(|name| *name == entry.name)
            .unwrap_or(recent.len())
    };
    found.sort_by_key(|(rank, entry)| (*rank, entry.obstacle.is_some(), age(entry)));
    found.into_iter().map(|(_, entry)| entry).collect()
}

/// Returns true if a command's name or its keywords contain the typed text, in lower case.
pub fn is_named(name: &str, keywords: &str, typed: &str) -> bool {
    rank(name, keywords, typed).is_some_and(|rank| rank < LETTERS)
}

/// The rank of names that only have the typed letters in order.
const LETTERS: u8 = 3;

fn rank(name: &str, keywords: &str, typed: &str) -> Option<u8> {
    if name.starts_with(typed) {
        return Some(0);
    }
    if name.contains(typed) {
        return Some(1);
    }
    if keywords.starts_with(typed) || keywords.contains(&format!(" {typed}")) {
        return Some(2);
    }
    let mut letters = name.chars();
    typed
        .chars()
        .all(|letter| letters.any(|other| other == letter))
        .then_some(LETTERS)
}

#[cfg(test)]
mod tests {
    use super::rank;

    #[test]
    fn what_begins_so_comes_before_what_has_it_then_other_words_for_it_and_letters_in_order_come_last() {
        assert_eq!(rank("reset handle", "clear", "res"), Some(0));
        assert_eq!(rank("delete handle", "", "han"), Some(1));
        assert_eq!(rank("turn", "rotate spin", "rot"), Some(2));
        assert_eq!(rank("turn", "rotate spin", "spin"), Some(2));
        assert_eq!(rank("delete handle", "", "dh"), Some(3));
        assert_eq!(rank("turn", "rotate spin", "tate"), None);
        assert_eq!(rank("delete handle", "", "xq"), None);
        assert_eq!(rank("anything", "", ""), Some(0));
    }
}
