//! One press a frame: the window system's events reach egui in portions that no frame can mix up.
//!
//! A slow frame gathers a click, the key that opens the palette and the letters typed into it. The receiver of events
//! is decided once a frame, so all three would go to the same one. A portion therefore ends where the receiver may
//! change; the rest comes in the next frame, which is requested at once.

use std::collections::VecDeque;

use eframe::egui::{Context, Event, Key, Plugin, PointerButton, RawInput};

/// Two clicks within so many seconds are a double click, as on most systems. Events within one frame have one time, so
/// this is also the slowest frame with which double clicks work.
const DOUBLE_CLICK: f64 = 0.5;

/// The least time from a frame to the next, in seconds.
const MOMENT: f64 = 1e-4;

/// Events that wait for a frame of their own, in the order in which they happened.
#[derive(Debug, Default)]
pub struct EventQueue {
    waiting: VecDeque<(Event, f64)>,
    /// The time of the events that come in now, in seconds.
    now: f64,
    /// The time of the last event that was handed on. egui measures double clicks by it: slow frames, and the frames of
    /// each press, would put two clicks too far apart.
    heard: f64,
    /// Keys that are down: if the system reports one again it is a repeat, which otherwise only egui itself marks.
    held: Vec<Key>,
    /// The pointer's buttons that are down, each with the event of its release at the pointer's last place.
    held_buttons: Vec<(PointerButton, Event)>,
    typing: bool,
    /// Frames, this one included, in which the text typed before Escape is still undone.
    escaped: u8,
}

impl EventQueue {
    /// Returns true if events of this moment wait for the next frame.
    pub fn has_more(context: &Context) -> bool {
        context
            .with_plugin(|queue: &mut Self| !queue.waiting.is_empty())
            .unwrap_or(false)
    }

    /// Returns true if a field had the keyboard when this frame's events were handed over: all its keys belong to the
    /// field, even if one of them (Enter, Escape) made the field lose it.
    pub fn is_typing(context: &Context) -> bool {
        context.with_plugin(|queue: &mut Self| queue.typing).unwrap_or(false)
    }

    /// Returns true if Escape has ended the typing into a field in this frame or the last.
    pub fn has_escaped(context: &Context) -> bool {
        context
            .with_plugin(|queue: &mut Self| queue.escaped > 0)
            .unwrap_or(false)
    }

    /// Marks the press of a key that is already down as a repeat.
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

    /// The releases of the buttons that are down when the window loses the focus: the system does not say when a button
    /// goes up over a window that was minimised, so that its drag would go on without the button.
    fn releases_before(&mut self, event: &Event) -> Vec<Event> {
        match event {
            Event::PointerButton {
                pos,
                button,
                pressed,
                modifiers,
            } => {
                self.held_buttons.retain(|(held, _)| held != button);
                if *pressed {
                    let release = Event::PointerButton {
                        pos: *pos,
                        button: *button,
                        pressed: false,
                        modifiers: *modifiers,
                    };
                    self.held_buttons.push((*button, release));
                }
            }
            Event::PointerMoved(now) => {
                for (_, release) in &mut self.held_buttons {
                    if let Event::PointerButton { pos, .. } = release {
                        *pos = *now;
                    }
                }
            }
            Event::WindowFocused(false) => {
                let held = std::mem::take(&mut self.held_buttons);
                return held.into_iter().map(|(_, release)| release).collect();
            }
            _ => {}
        }
        Vec::new()
    }

    /// Takes the events since the last frame and leaves those for this frame. `typing` says whether a field has the
    /// keyboard: letters for it come together.
    fn portion(&mut self, events: &mut Vec<Event>, typing: bool) {
        self.typing = typing;
        for mut event in events.drain(..) {
            self.tell_repeat(&mut event);
            for release in self.releases_before(&event) {
                self.waiting.push_back((release, self.now));
            }
            self.waiting.push_back((event, self.now));
        }
        let (mut is_typed, mut is_decided, mut is_button) = (false, false, false);
        while let Some((event, came)) = self.waiting.front() {
            // The pointer's place is known once a frame: a press counts at its own place, not at the pointer's later
            // one.
            let moves_on = is_button && matches!(event, Event::PointerMoved(_) | Event::PointerGone);
            let decides = is_press(event) && may_change_listener(event, typing);
            // Enter and Tab count for all of the text before them: a dialog may look at its keys before its fields.
            let leaves_text = is_typed && decides;
            if (is_decided && is_press(event)) || moves_on || leaves_text {
                break;
            }
            is_decided |= decides;
            is_typed |=
                typing && (is_press(event) || matches!(event, Event::Text(_) | Event::Paste(_) | Event::Ime(_)));
            is_button |= matches!(event, Event::PointerButton { .. });
            self.heard = *came;
            events.extend(self.waiting.pop_front().map(|(event, _)| event));
        }
        let escapes = |event: &Event| is_press(event) && matches!(event, Event::Key { key: Key::Escape, .. });
        self.escaped = match typing && events.iter().any(escapes) {
            true => 2,
            false => self.escaped.saturating_sub(1),
        };
    }
}

/// Returns true if the event is a press of its own: a key's letter comes with the key, and a key that is held down goes
/// to its first receiver.
fn is_press(event: &Event) -> bool {
    match event {
        Event::PointerButton { .. } => true,
        Event::Key { pressed, repeat, .. } => *pressed && !repeat,
        _ => false,
    }
}

/// Returns true if another receiver may get the events after this press.
fn may_change_listener(event: &Event, typing: bool) -> bool {
    match event {
        Event::Key { key, modifiers, .. } => !typing || modifiers.command || modifiers.alt || leaves_field(*key),
        _ => true,
    }
}

/// Returns true if this press may take the keyboard from a field that has it.
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

    fn setup(&mut self, context: &Context) {
        context.options_mut(|options| options.input_options.max_double_click_delay = DOUBLE_CLICK);
    }

    fn input_hook(&mut self, context: &Context, input: &mut RawInput) {
        let last = self.heard;
        self.now = input.time.unwrap_or_default();
        self.portion(&mut input.events, context.memory(|memory| memory.focused().is_some()));
        if let Some(time) = &mut input.time {
            // Time goes on, if only by a moment.
            self.heard = match input.events.is_empty() {
                true => *time,
                false => self.heard.max(last + MOMENT),
            };
            *time = self.heard;
        }
        if !self.waiting.is_empty() {
            context.request_repaint();
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{InputState, Modifiers, pos2};

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
    fn two_clicks_that_come_in_one_slow_frame_are_a_double_click_and_time_never_goes_back() {
        let context = Context::default();
        context.add_plugin(EventQueue::default());
        let (mut counts, mut times) = (Vec::new(), Vec::new());
        for frame in 0..8 {
            let clicks = [button(true), button(false), button(true), button(false)];
            let input = RawInput {
                time: Some(10.0 + 0.4 * f64::from(frame)),
                events: if frame == 1 { clicks.to_vec() } else { Vec::new() },
                ..RawInput::default()
            };
            let mut output = context.run_ui(input, |ui| {
                times.push(ui.input(|input| input.time));
                if ui.input(|input| input.pointer.primary_released()) {
                    let is_double = |input: &InputState| input.pointer.button_double_clicked(PointerButton::Primary);
                    counts.push(ui.input(is_double));
                }
            });
            output.textures_delta.clear();
        }
        assert_eq!(counts, [false, true]);
        assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{times:?}");
    }

    #[test]
    fn a_button_that_is_down_when_the_window_loses_the_focus_is_released_where_the_pointer_is() {
        let place = pos2(7.0, 8.0);
        let left = Event::WindowFocused(false);
        let events = vec![button(true), Event::PointerMoved(place), left.clone(), left.clone()];
        let all = portions(events, false).concat();
        let released = Event::PointerButton {
            pos: place,
            button: PointerButton::Primary,
            pressed: false,
            modifiers: Modifiers::NONE,
        };
        assert_eq!(
            all,
            [
                button(true),
                Event::PointerMoved(place),
                released,
                left.clone(),
                left.clone()
            ]
        );
        let unheld = vec![button(true), button(false), left];
        assert_eq!(portions(unheld.clone(), false).concat(), unheld);
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
        let lengths: Vec<usize> = parts.iter().map(Vec::len).collect();
        assert_eq!(
            lengths,
            [4, 1, 1],
            "Enter finds the text in its field, and what follows it is for whoever has the keys then"
        );
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
