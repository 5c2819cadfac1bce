//! The keys of commands: the program's own, unless a person has chosen others.

use std::collections::BTreeMap;

use super::shortcut::Shortcut;
use super::table::Command;
use crate::input::{Key, Modifiers};

/// A person's choice of keys for some of the listed commands.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct KeyMap {
    chosen: Vec<(Command, Vec<Shortcut>)>,
}

impl KeyMap {
    /// The keys by the commands' names, as "Ctrl+Shift+Z"; each unknown command or key is left out and reported in a
    /// sentence.
    pub fn of_names(names: &BTreeMap<String, Vec<String>>) -> (Self, Vec<String>) {
        let (mut map, mut problems) = (Self::default(), Vec::new());
        for (name, keys) in names {
            let Some(listed) = Command::all_listed().find(|listed| listed.name == name) else {
                problems.push(format!("No command has the name \"{name}\", so its keys are ignored."));
                continue;
            };
            let mut shortcuts = Vec::new();
            for key in keys {
                match Shortcut::parse(key) {
                    Some(shortcut) => shortcuts.push(shortcut),
                    None => problems.push(format!(
                        "\"{key}\" for \"{name}\" is not a key: write it like Ctrl+Shift+Z."
                    )),
                }
            }
            map.chosen.push((listed.command.clone(), shortcuts));
        }
        (map, problems)
    }

    /// The command that a key sends: a person's choice has priority over the program's.
    pub fn command(&self, key: Key, modifiers: Modifiers) -> Option<Command> {
        let pressed = Shortcut { modifiers, key };
        let chosen = self.chosen.iter().find(|(_, shortcuts)| shortcuts.contains(&pressed));
        if let Some((command, _)) = chosen {
            return Some(command.clone());
        }
        Command::all_listed()
            .find(|listed| listed.shortcuts.contains(&pressed) && !self.has(&listed.command))
            .map(|listed| listed.command.clone())
    }

    /// The keys that send a command; the first is shown.
    pub fn shortcuts(&self, command: &Command) -> &[Shortcut] {
        match self.chosen.iter().find(|(chosen, _)| chosen == command) {
            Some((_, shortcuts)) => shortcuts,
            None => command.listed().map_or(&[], |listed| listed.shortcuts),
        }
    }

    fn has(&self, command: &Command) -> bool {
        self.chosen.iter().any(|(chosen, _)| chosen == command)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use super::KeyMap;
    use crate::{Command, Key, Modifiers, Shortcut};

    #[test]
    fn every_listed_key_is_read_as_it_is_written_and_none_is_given_twice() {
        let mut seen = BTreeSet::new();
        for shortcut in Command::all_listed().flat_map(|listed| listed.shortcuts) {
            let label = shortcut.label();
            assert_eq!(Shortcut::parse(&label), Some(*shortcut), "{label}");
            assert!(seen.insert(label.clone()), "{label} is given twice");
        }
        for wrong in ["", "Ctrl+", "Hyper+Z", "F99"] {
            assert_eq!(Shortcut::parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn a_chosen_key_comes_before_the_programs_and_what_is_not_understood_is_said() {
        let names = BTreeMap::from([
            ("Move".to_owned(), vec!["W".to_owned()]),
            ("Fly".to_owned(), vec!["F".to_owned()]),
            ("Turn".to_owned(), vec!["Hyper+T".to_owned()]),
        ]);
        let (map, problems) = KeyMap::of_names(&names);
        assert_eq!(problems.len(), 2, "{problems:?}");
        let command = |letter| map.command(Key::Character(letter), Modifiers::NONE);
        assert_eq!(command('w'), Some(Command::Move));
        assert_eq!(command('g'), None, "its own key is free now");
        assert_eq!(command('s'), Some(Command::Scale));
        assert_eq!(map.shortcuts(&Command::Move)[0].label(), "W");
        assert_eq!(map.shortcuts(&Command::Undo), Command::Undo.listed().unwrap().shortcuts);
    }
}
