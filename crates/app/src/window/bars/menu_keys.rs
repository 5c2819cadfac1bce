//! The keys of the menu bar: F10 opens the first menu, Alt and a letter its own one. Inside a menu the arrows go up and
//! down, and to the neighbouring menus.

use eframe::egui::{Context, Key, KeyboardShortcut, Modifiers, Popup, Response};

/// The key of a menu with this letter.
pub fn shortcut(letter: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::ALT, letter)
}

/// Opens the menu that a key asks for, from the buttons of the bar with their letters.
pub fn follow(context: &Context, buttons: &[(Response, Key)]) {
    let is_pressed = |modifiers, key| context.input_mut(|input| input.consume_key(modifiers, key));
    let asked = buttons.iter().find(|(_, letter)| is_pressed(Modifiers::ALT, *letter));
    let first = buttons.first().filter(|_| is_pressed(Modifiers::NONE, Key::F10));
    if let Some((button, _)) = asked.or(first) {
        open(context, button);
        button.request_focus();
        return;
    }
    let is_open = |button: &Response| Popup::is_id_open(context, Popup::default_response_id(button));
    let is_any_open = buttons.iter().any(|(button, _)| is_open(button));
    // The arrows have moved the focus to another menu's button.
    let entered = buttons
        .iter()
        .find(|(button, _)| button.gained_focus() && !is_open(button));
    if let Some((button, _)) = entered.filter(|_| is_any_open) {
        open(context, button);
    }
}

fn open(context: &Context, button: &Response) {
    Popup::open_id(context, Popup::default_response_id(button));
    context.request_repaint();
}
