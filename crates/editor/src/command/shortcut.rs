//! A key with its modifiers, written and read as "Ctrl+Shift+Z".

use crate::input::{Key, Modifiers};

/// A key with its modifiers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Shortcut {
    /// Exactly these modifiers are held.
    pub modifiers: Modifiers,
    /// The key.
    pub key: Key,
}

impl Shortcut {
    pub(crate) const fn with(modifiers: Modifiers, key: Key) -> Self {
        Self { modifiers, key }
    }

    /// Its form in menus: "Ctrl+Shift+Z".
    pub fn label(&self) -> String {
        let mut label = String::new();
        for (held, name) in [
            (self.modifiers.ctrl, "Ctrl+"),
            (self.modifiers.alt, "Alt+"),
            (self.modifiers.shift, "Shift+"),
        ] {
            if held {
                label.push_str(name);
            }
        }
        match self.key {
            Key::Character(' ') => label.push_str("Space"),
            Key::Character(character) => label.extend(character.to_uppercase()),
            Key::Escape => label.push_str("Esc"),
            Key::Enter => label.push_str("Enter"),
            Key::Backspace => label.push_str("Backspace"),
            Key::Delete => label.push_str("Delete"),
            Key::Home => label.push_str("Home"),
            Key::Tab => label.push_str("Tab"),
            Key::Numpad(digit) => label.push_str(&format!("Num {digit}")),
        }
        label
    }

    /// Reads the text of [`Shortcut::label`].
    pub fn parse(text: &str) -> Option<Self> {
        let mut modifiers = Modifiers::NONE;
        let mut rest = text.trim();
        // "Ctrl++" is Ctrl and the plus key.
        let prefix = |text: &str| {
            let (word, after) = text.split_once('+')?;
            (!word.is_empty() && !after.is_empty()).then(|| (word.to_lowercase(), word.len() + 1))
        };
        while let Some((word, length)) = prefix(rest) {
            match word.as_str() {
                "ctrl" | "cmd" | "command" => modifiers.ctrl = true,
                "alt" | "option" => modifiers.alt = true,
                "shift" => modifiers.shift = true,
                _ => return None,
            }
            rest = &rest[length..];
        }
        let mut letters = rest.chars();
        let key = match (letters.next(), letters.next(), rest.to_lowercase().as_str()) {
            (Some(letter), None, _) => Key::Character(letter.to_ascii_lowercase()),
            (.., "esc" | "escape") => Key::Escape,
            (.., "enter" | "return") => Key::Enter,
            (.., "backspace") => Key::Backspace,
            (.., "delete") => Key::Delete,
            (.., "home") => Key::Home,
            (.., "tab") => Key::Tab,
            (.., "space") => Key::Character(' '),
            // "Num 5": a digit of the numeric pad.
            (.., name) => {
                let digit = name.strip_prefix("num ")?.parse().ok()?;
                (digit < 10).then_some(Key::Numpad(digit))?
            }
        };
        Some(Self { modifiers, key })
    }
}
