//! Input: the pointer, its buttons, keys and modifiers.

use glam::DVec2;

/// The position of the pointer, and the held modifier keys.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Pointer {
    /// Position within the view in points, x to the right and y down from its upper left corner.
    pub position_px: DVec2,
    /// The modifier keys.
    pub modifiers: Modifiers,
}

/// The held modifier keys.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub struct Modifiers {
    /// Shift.
    pub shift: bool,
    /// Ctrl, or Command on a Mac.
    pub ctrl: bool,
    /// Alt, or Option on a Mac.
    pub alt: bool,
}

impl Modifiers {
    /// No modifier key.
    pub const NONE: Self = Self {
        shift: false,
        ctrl: false,
        alt: false,
    };
    /// Shift alone.
    pub const SHIFT: Self = Self {
        shift: true,
        ctrl: false,
        alt: false,
    };
    /// Ctrl (or Command) alone.
    pub const CTRL: Self = Self {
        shift: false,
        ctrl: true,
        alt: false,
    };
    /// Ctrl (or Command) and Shift.
    pub const CTRL_SHIFT: Self = Self {
        shift: true,
        ctrl: true,
        alt: false,
    };
    /// Alt (or Option) alone.
    pub const ALT: Self = Self {
        shift: false,
        ctrl: false,
        alt: true,
    };
}

/// A button of the mouse.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum Button {
    /// The left button: the tool.
    Primary,
    /// The middle button: the camera.
    Middle,
    /// The right button: aborts the active gesture, or else moves the camera; a click opens the menu.
    Secondary,
}

/// A key with a meaning in the editor.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum Key {
    /// A key that types a character: letters in lower case, digits, punctuation.
    Character(char),
    /// Escape.
    Escape,
    /// Enter.
    Enter,
    /// Backspace.
    Backspace,
    /// Delete.
    Delete,
    /// Home.
    Home,
    /// Tab.
    Tab,
    /// A digit of the numeric pad.
    Numpad(u8),
}
