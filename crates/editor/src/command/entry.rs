//! A command's entry in the table: everything about it, in one place.

use std::borrow::Cow;

use crate::document::{Handle, HandleId};
use crate::input::{Key, Modifiers};
use crate::tool::{Context, Gesture, ToolSettings};
use crate::view::View;
use crate::workspace::Workspace;

use super::shortcut::Shortcut;

/// The reason why a command can't be executed now, as a sentence with the remedy if there is one.
pub(super) type Reason = Cow<'static, str>;

/// A command of the table. `V` are its values: `()` for none, one, or a tuple.
pub(super) struct Entry<V: 'static> {
    /// Its forms in menus, the palette and the list of keys, one for each value that they offer.
    pub(super) listed: &'static [Item<V>],
    pub(super) scope: Scope,
    /// The reason why it can't be executed now; `None` if it can.
    pub(super) unavailable: fn(&State<'_>, &V) -> Option<Reason>,
    pub(super) action: Action<V>,
}

/// A command with its values, in a menu or the palette.
#[derive(Debug)]
pub(super) struct Item<V> {
    pub(super) values: V,
    /// Its name in a menu.
    pub(super) name: &'static str,
    /// One sentence on its effect.
    pub(super) tooltip: &'static str,
    /// Its other names, in lower case.
    pub(super) keywords: &'static str,
    /// Its own keys; the first is shown.
    pub(super) shortcuts: &'static [Shortcut],
}

/// The part of the program that a command changes, which decides the fate of the active gesture.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Scope {
    /// View, look or brush: the gesture continues.
    View,
    /// The tool: the gesture is aborted.
    Tool,
    /// The document or the selection: the gesture is aborted, and the last refusal is forgotten.
    Document,
    /// The history: an active gesture is undone, and nothing before it.
    History,
    /// Like the document, with its own gesture.
    Gesture,
}

/// The effect of a command.
pub(super) enum Action<V> {
    /// An immediate effect.
    Do(fn(&mut Context<'_>, V)),
    /// The beginning of a gesture, if it can begin.
    Begin(fn(&mut Context<'_>, V) -> Option<Box<dyn Gesture>>),
}

/// The state by which commands decide whether they can be executed.
#[derive(Clone, Copy)]
pub(crate) struct State<'a> {
    pub(crate) workspace: &'a Workspace,
    pub(crate) view: &'a View,
    pub(crate) settings: &'a ToolSettings,
}

impl State<'_> {
    /// The reason if no file is open.
    pub(super) fn unopened(&self) -> Option<Reason> {
        unless(self.workspace.model().is_some(), "Nothing is open: open a file first.")
    }

    /// The reason if the document is in a work pose, from which it must be able to return exactly.
    pub(super) fn in_work_pose(&self) -> Option<Reason> {
        let is_outside = self.workspace.document.work_pose().is_none();
        unless(
            is_outside,
            "This would change the shape to return to: leave the work pose first.",
        )
    }

    /// The reason if a sequence is open, in which the change would fit only one frame.
    pub(super) fn in_sequence(&self) -> Option<Reason> {
        let is_single = self.workspace.document.animation().frames().is_none();
        unless(
            is_single,
            "This would fit only one frame of the sequence: open the frame alone, or move handles and set keys.",
        )
    }

    /// The selected handle.
    pub(super) fn selected(&self) -> Result<&Handle, Reason> {
        let none = "No handle is selected: select one in the list, or paint one.";
        self.workspace.selected().ok_or(none.into())
    }

    /// The selected handle, if it may be changed.
    pub(super) fn unlocked(&self) -> Result<&Handle, Reason> {
        self.selected().and_then(unlocked)
    }

    /// The reason if a handle no longer exists.
    pub(super) fn gone(&self, id: HandleId) -> Option<Reason> {
        let handle = self.workspace.document.handle(id);
        unless(handle.is_some(), "This handle no longer exists.")
    }
}

/// The handle, if it may be changed.
pub(super) fn unlocked(handle: &Handle) -> Result<&Handle, Reason> {
    if handle.locked {
        return Err(format!("{} is locked: unlock it in the list first.", handle.name).into());
    }
    Ok(handle)
}

/// The reason, unless the command can be executed.
pub(super) fn unless(can_be_done: bool, reason: &'static str) -> Option<Reason> {
    (!can_be_done).then_some(Cow::Borrowed(reason))
}

/// For commands that can always be executed.
pub(super) fn always<V>(_: &State<'_>, _: &V) -> Option<Reason> {
    None
}

/// For commands that need an open file.
pub(super) fn when_open<V>(state: &State<'_>, _: &V) -> Option<Reason> {
    state.unopened()
}

/// For commands that need a handle, selected or not.
pub(super) fn with_handles<V>(state: &State<'_>, _: &V) -> Option<Reason> {
    let is_any = !state.workspace.document.handles().is_empty();
    unless(is_any, "There is no handle yet: paint one on the surface.")
}

/// For commands that need a selected handle that is not locked.
pub(super) fn with_unlocked<V>(state: &State<'_>, _: &V) -> Option<Reason> {
    state.unlocked().err()
}

/// For commands that need a selected handle.
pub(super) fn with_selected<V>(state: &State<'_>, _: &V) -> Option<Reason> {
    state.selected().err()
}

pub(super) const fn item<V>(
    values: V,
    name: &'static str,
    tooltip: &'static str,
    keywords: &'static str,
    shortcuts: &'static [Shortcut],
) -> Item<V> {
    Item {
        values,
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
