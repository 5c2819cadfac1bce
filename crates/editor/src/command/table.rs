//! The commands that need no argument, as menus, the palette and the list of keys show them: a file for each room.

use super::{document, handle, look, object, paint, region, view};
use crate::{Command, Key, Modifiers, Shortcut};

/// A command as a menu or the palette lists it.
#[derive(Clone, PartialEq, Debug)]
pub struct Listed {
    /// What is sent.
    pub command: Command,
    /// Its name in a menu.
    pub name: &'static str,
    /// One sentence that says what it does.
    pub tooltip: &'static str,
    /// What else people call it, in lower case: the palette finds it by these words too.
    pub keywords: &'static str,
    /// Keys that send it; the first is shown.
    pub shortcuts: &'static [Shortcut],
}

/// The commands of one room, in the order of a menu.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CommandGroup {
    /// What the room is called.
    pub name: &'static str,
    /// Its commands.
    pub commands: &'static [Listed],
}

impl Command {
    /// Every command that needs no argument, by rooms.
    pub const GROUPS: &'static [CommandGroup] = &[
        group("Document", document::LISTED),
        group("Painting", paint::LISTED),
        group("Handles", handle::LISTED),
        group("Regions", region::LISTED),
        group("Objects", object::LISTED),
        group("View", view::LISTED),
        group("Shading", look::LISTED),
    ];

    /// Every command that needs no argument, in the order of the rooms.
    pub fn all_listed() -> impl Iterator<Item = &'static Listed> {
        Self::GROUPS.iter().flat_map(|group| group.commands)
    }

    /// How this command is listed, if it needs no argument.
    pub fn listed(&self) -> Option<&'static Listed> {
        Self::all_listed().find(|listed| listed.command == *self)
    }
}

pub(super) const fn group(name: &'static str, commands: &'static [Listed]) -> CommandGroup {
    CommandGroup { name, commands }
}

pub(super) const fn listed(
    command: Command,
    name: &'static str,
    tooltip: &'static str,
    keywords: &'static str,
    shortcuts: &'static [Shortcut],
) -> Listed {
    Listed {
        command,
        name,
        tooltip,
        keywords,
        shortcuts,
    }
}

pub(super) const fn plain(key: Key) -> Shortcut {
    Shortcut::with(Modifiers::NONE, key)
}

pub(super) const fn character(character: char) -> Shortcut {
    plain(Key::Character(character))
}

pub(super) const fn ctrl(character: char) -> Shortcut {
    Shortcut::with(Modifiers::CTRL, Key::Character(character))
}

pub(super) const fn shift(character: char) -> Shortcut {
    Shortcut::with(Modifiers::SHIFT, Key::Character(character))
}

pub(super) const fn alt(character: char) -> Shortcut {
    Shortcut::with(Modifiers::ALT, Key::Character(character))
}

pub(super) const fn numpad(digit: u8) -> Shortcut {
    plain(Key::Numpad(digit))
}

pub(super) const fn ctrl_numpad(digit: u8) -> Shortcut {
    Shortcut::with(Modifiers::CTRL, Key::Numpad(digit))
}
