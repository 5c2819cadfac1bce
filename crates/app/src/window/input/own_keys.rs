//! Keys that the window itself handles, before the editor: those for files, for the palette, for copying text. A
//! command of the editor with one of them would never get it.

use std::collections::BTreeMap;

use eframe::egui;
use pliant_editor::{Key, Modifiers, Shortcut};

use super::{held_modifiers, key_of, pressed_key};
use crate::window::input::file_command::FileCommand;

/// The menus of the bar, each with the letter that opens it together with Alt. Alt and H shows everything that is hidden.
pub const MENUS: [(&str, egui::Key); 7] = [
    ("File", egui::Key::F),
    ("Edit", egui::Key::E),
    ("Region", egui::Key::R),
    ("Mesh", egui::Key::M),
    ("View", egui::Key::V),
    ("Window", egui::Key::W),
    ("Help", egui::Key::P),
];

/// The key that opens a menu with this letter.
pub fn menu_key(letter: egui::Key) -> egui::KeyboardShortcut {
    egui::KeyboardShortcut::new(egui::Modifiers::ALT, letter)
}

/// The key that went down in this frame, even if the window system has turned it into "copy", "cut" or "paste"; a
/// sentence if a command can't have it.
pub fn pressed(input: &egui::InputState) -> Option<Result<Shortcut, String>> {
    let of_text = |event: &egui::Event| match event {
        egui::Event::Copy => Some('c'),
        egui::Event::Cut => Some('x'),
        egui::Event::Paste(_) => Some('v'),
        _ => None,
    };
    let of_text = input.events.iter().find_map(of_text).map(|letter| Shortcut {
        modifiers: Modifiers::CTRL,
        key: Key::Character(letter),
    });
    let known = of_text.or_else(|| pressed_key(input).map(|(key, modifiers)| Shortcut { modifiers, key }));
    let unknown = |event: &egui::Event| match event {
        egui::Event::Key { key, pressed: true, .. } => {
            let name = key.symbol_or_name();
            Some(format!(
                "{name} can't be a command's key: press a letter, a digit or a sign."
            ))
        }
        _ => None,
    };
    known.map(Ok).or_else(|| input.events.iter().find_map(unknown).map(Err))
}

/// The reason why a command of the editor can't have this key, in a sentence, if it is the window's.
pub fn refusal(key: Shortcut, command: &str) -> Option<String> {
    let holder = holder(key)?;
    let key = key.label();
    Some(format!(
        "{key} is already the key of {holder}: press another key for “{command}”."
    ))
}

/// Takes the window's keys out of those that a person has chosen for the editor's commands, with a sentence each.
pub fn refuse(chosen: &mut BTreeMap<String, Vec<String>>) -> Vec<String> {
    let mut sentences = Vec::new();
    for (command, keys) in chosen {
        keys.retain(|text| {
            let refusal = Shortcut::parse(text).and_then(|key| refusal(key, command));
            let is_free = refusal.is_none();
            sentences.extend(refusal);
            is_free
        });
    }
    sentences
}

/// The window's action for this key.
fn holder(key: Shortcut) -> Option<String> {
    let of_files = FileCommand::WITH_SHORTCUTS
        .iter()
        .find(|command| command.shortcut().and_then(editors) == Some(key));
    if let Some(command) = of_files {
        return Some(format!("“{}”", command.name().trim_end_matches('…')));
    }
    let menu = MENUS.iter().find(|(_, letter)| editors(menu_key(*letter)) == Some(key));
    if let Some((name, _)) = menu {
        return Some(format!("the menu “{name}”"));
    }
    let of_text = [('c', "copying text"), ('x', "cutting text"), ('v', "pasting text")];
    let is_of_text = |letter: char| key.modifiers == Modifiers::CTRL && key.key == Key::Character(letter);
    of_text
        .iter()
        .find(|(letter, _)| is_of_text(*letter))
        .map(|(_, what)| (*what).to_owned())
}

/// A key of egui's in the editor's notation; `None` for unknown ones.
fn editors(shortcut: egui::KeyboardShortcut) -> Option<Shortcut> {
    Some(Shortcut {
        modifiers: held_modifiers(shortcut.modifiers),
        key: key_of(shortcut.logical_key)?,
    })
}

#[cfg(test)]
mod tests {
    use pliant_editor::Command;

    use super::*;

    #[test]
    fn a_key_of_the_windows_is_refused_by_the_name_of_who_has_it() {
        let ctrl = |letter| Shortcut {
            modifiers: Modifiers::CTRL,
            key: Key::Character(letter),
        };
        let said = refusal(ctrl('s'), "Move").unwrap_or_default();
        assert!(said.contains("Ctrl+S") && said.contains("Save model"), "{said}");
        assert!(refusal(ctrl('c'), "Move").is_some_and(|said| said.contains("copying")));
        assert_eq!(refusal(ctrl('j'), "Move"), None);
        let mut chosen = BTreeMap::from([(
            "Move".to_owned(),
            vec!["Ctrl+S".to_owned(), "W".to_owned(), "no key".to_owned()],
        )]);
        assert_eq!(refuse(&mut chosen).len(), 1);
        assert_eq!(chosen["Move"], ["W", "no key"], "the editor tells of what is no key");
    }

    #[test]
    fn no_command_of_the_editors_has_a_key_of_the_windows() {
        for listed in Command::all_listed() {
            for key in listed.shortcuts {
                assert_eq!(holder(*key), None, "{} has {}", listed.name, key.label());
            }
        }
    }

    #[test]
    fn every_key_that_the_window_listens_to_is_known_here() {
        let all = FileCommand::LISTED.iter().chain(&FileCommand::WITH_SHORTCUTS);
        for command in all.filter(|command| command.shortcut().is_some()) {
            assert!(
                FileCommand::WITH_SHORTCUTS.contains(command),
                "{command:?} is not listened to"
            );
        }
    }
}
