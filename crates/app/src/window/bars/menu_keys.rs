//! The keys of the menu bar: F10 opens the first menu, Alt and a letter its own one. Inside a menu the arrows go up and
//! down, and to the neighbouring menus.

use eframe::egui::{Context, Key, Modifiers, Popup, Response};

use crate::window::input::own_keys::menu_key;

/// Opens the menu that a key asks for, from the buttons of the bar with their letters.
pub fn follow(context: &Context, buttons: &[(Response, Key)]) {
    let is_pressed = |modifiers, key| context.input_mut(|input| input.consume_key(modifiers, key));
    let is_asked = |letter: Key| context.input_mut(|input| input.consume_shortcut(&menu_key(letter)));
    let asked = buttons.iter().find(|(_, letter)| is_asked(*letter));
    let first = buttons.first().filter(|_| is_pressed(Modifiers::NONE, Key::F10));
    if let Some((button, _)) = asked.or(first) {
        open(context, button);
        button.request_focus();
        return;
    }
    let is_open = |button: &Response| Popup::is_id_open(context, Popup::default_response_id(button));
    // Inside a menu the arrow to the left leads to the menu's button, and from there on to the neighbour.
    let Some(place) = buttons
        .iter()
        .position(|(button, _)| is_open(button) && button.has_focus())
    else {
        return;
    };
    let count = buttons.len();
    let next = match [Key::ArrowLeft, Key::ArrowRight].map(|key| is_pressed(Modifiers::NONE, key)) {
        [true, _] => (place + count - 1) % count,
        [_, true] => (place + 1) % count,
        [false, false] => return,
    };
    let (button, _) = &buttons[next];
    open(context, button);
    button.request_focus();
}

fn open(context: &Context, button: &Response) {
    Popup::open_id(context, Popup::default_response_id(button));
    context.request_repaint();
}
