//! One press a frame: what the window system delivers is handed to egui in portions that no frame can mix up.
//!
//! A slow frame gathers a click, the key that opens the palette and the letters typed into it. Whoever hears an event is
//! decided once a frame, so all three would go to the same listener. A portion therefore ends where the listener may
//! change; what is left comes in the next frame, which is asked for at once.

use std::collections::VecDeque;

use eframe::egui::{Context, Event, Key, Plugin, RawInput};

/// Events that wait for a frame of their own, in the order in which they happened.
#[derive(Debug, Default)]
pub struct EventQueue {
    waiting: VecDeque<Event>,
    /// Keys that are down: what the system tells of them again is a repeat, which only egui itself says otherwise.
    held: Vec<Key>,
    typing: bool,
    /// Frames, this one included, in which what was typed before Escape is still taken back.
    escaped: u8,
}

impl EventQueue {
    /// Whether events of this moment wait for the next frame.
    pub fn has_more(context: &Context) -> bool {
        context
            .with_plugin(|queue: &mut Self| !queue.waiting.is_empty())
            .unwrap_or(false)
    }

    /// Whether a field had the keys when this frame's events were handed over: all its keys belong to the field, also
    /// where one of them (Enter, Escape) has made the field let go.
    pub fn is_typing(context: &Context) -> bool {
        context.with_plugin(|queue: &mut Self| queue.typing).unwrap_or(false)
    }

    /// Whether Escape has ended the typing into a field in this frame or the last.
    pub fn has_escaped(context: &Context) -> bool {
        context
            .with_plugin(|queue: &mut Self| queue.escaped > 0)
            .unwrap_or(false)
    }

    /// Marks the press of a key that is down already as a repeat.
    fn tell_repeat(&mut self, event: &mut Event) {
        match event {
            Event::Key {
                key,
                pressed: true,
                repeat,
                ..
            } => {
                let is_held = self.held.contains(key);
                *repeat |= is_held;
                if !is_held {
                    self.held.push(*key);
                }
            }
            Event::Key {
                key, pressed: false, ..
            } => self.held.retain(|held| held != key),
            Event::WindowFocused(false) => self.held.clear(),
            _ => {}
        }
    }

    /// Takes what happened since the last frame and leaves what this frame shall hear. `typing` says whether a field has
    /// the keys: letters that go into it come together.
    fn portion(&mut self, events: &mut Vec<Event>, typing: bool) {
        self.typing = typing;
        for mut event in events.drain(..) {
            self.tell_repeat(&mut event);
            self.waiting.push_back(event);
        }
        let (mut is_decided, mut is_button) = (false, false);
        while let Some(event) = self.waiting.front() {
            // The pointer's place is known once a frame: a press is judged where it happened, not where the pointer went.
            let moves_on = is_button && matches!(event, Event::PointerMoved(_) | Event::PointerGone);
            if (is_decided && is_press(event)) || moves_on {
                break;
            }
            is_decided |= is_press(event) && may_change_listener(event, typing);
            is_button |= matches!(event, Event::PointerButton { .. });
            events.extend(self.waiting.pop_front());
        }
        let escapes = |event: &Event| is_press(event) && matches!(event, Event::Key { key: Key::Escape, .. });
        self.escaped = match typing && events.iter().any(escapes) {
            true => 2,
            false => self.escaped.saturating_sub(1),
        };
    }
}

/// Whether the event is a press of its own: a key's letter comes with the key, and a key that is held down goes to
/// whoever heard it first.
fn is_press(event: &Event) -> bool {
    match event {
        Event::PointerButton { .. } => true,
        Event::Key { pressed, repeat, .. } => *pressed && !repeat,
        _ => false,
    }
}

/// Whether another listener may hear what comes after this press.
fn may_change_listener(event: &Event, typing: bool) -> bool {
    match event {
        Event::Key { key, modifiers, .. } => !typing || modifiers.command || modifiers.alt || leaves_field(*key),
        _ => true,
    }
}

/// Whether a field that is typed into may lose the keys by this one.
fn leaves_field(key: Key) -> bool {
    let is_function = || {
        let name = key.name();
        name.starts_with('F') && name[1..].parse::<u8>().is_ok()
    };
    matches!(key, Key::Enter | Key::Escape | Key::Tab) || is_function()
}

impl Plugin for EventQueue {
    fn debug_name(&self) -> &'static str {
        "event queue"
    }

    fn input_hook(&mut self, context: &Context, input: &mut RawInput) {
        self.portion(&mut input.events, context.memory(|memory| memory.focused().is_some()));
        if !self.waiting.is_empty() {
            context.request_repaint();
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Modifiers, PointerButton, pos2};

    use super::*;

    fn key(key: Key) -> Event {
        Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers: Modifiers::NONE,
        }
    }

    fn button(pressed: bool) -> Event {
        Event::PointerButton {
            pos: pos2(1.0, 2.0),
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        }
    }

    fn portions(events: Vec<Event>, typing: bool) -> Vec<Vec<Event>> {
        let mut queue = EventQueue::default();
        let mut portions = Vec::new();
        let mut events = events;
        loop {
            queue.portion(&mut events, typing);
            portions.push(std::mem::take(&mut events));
            if queue.waiting.is_empty() {
                return portions;
            }
        }
    }

    #[test]
    fn a_click_and_the_key_after_it_come_in_frames_of_their_own_in_order() {
        let moved = Event::PointerMoved(pos2(3.0, 4.0));
        let all = vec![moved.clone(), button(true), moved.clone(), button(false), key(Key::F1)];
        let parts = portions(all.clone(), false);
        assert_eq!(parts.concat(), all);
        let lengths: Vec<usize> = parts.iter().map(Vec::len).collect();
        assert_eq!(lengths, [2, 2, 1]);
    }

    #[test]
    fn what_a_held_key_repeats_comes_with_its_release_in_one_frame() {
        let mut released = key(Key::O);
        if let Event::Key { pressed, .. } = &mut released {
            *pressed = false;
        }
        let held = vec![key(Key::O), key(Key::O), key(Key::O), released, key(Key::O)];
        let lengths: Vec<usize> = portions(held, false).iter().map(Vec::len).collect();
        assert_eq!(lengths, [4, 1]);
    }

    #[test]
    fn a_key_comes_with_its_letter_and_letters_for_a_field_come_together() {
        let letters = vec![
            key(Key::A),
            Event::Text("a".into()),
            key(Key::B),
            Event::Text("b".into()),
        ];
        assert_eq!(portions(letters.clone(), false).len(), 2);
        assert_eq!(portions(letters.clone(), true).len(), 1);
        let mut entered = letters;
        entered.extend([key(Key::Enter), key(Key::Num2)]);
        let parts = portions(entered.clone(), true);
        assert_eq!(parts.concat(), entered);
        assert_eq!(parts[0].len(), 5, "what follows Enter is for whoever has the keys then");
    }

    #[test]
    fn a_key_held_down_and_a_moving_pointer_never_pile_up() {
        let repeated = Event::Key {
            key: Key::ArrowUp,
            physical_key: None,
            pressed: true,
            repeat: true,
            modifiers: Modifiers::NONE,
        };
        let moved = Event::PointerMoved(pos2(3.0, 4.0));
        let events = std::iter::repeat_n([repeated, moved], 50).flatten().collect();
        assert_eq!(portions(events, false).len(), 1);
    }
}
