//! From egui's events to the editor's: the events over the 3D view, in the view's own points.

pub(in crate::window) mod event_queue;
pub(in crate::window) mod file_command;
pub(in crate::window) mod own_keys;

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use eframe::egui::{self, MouseWheelUnit, PointerButton, Rect};
use glam::DVec2;
use pliant_editor::{Button, Event, Key, Modifiers, Pointer};

/// The points that a notch of the wheel scrolls, on systems that report points.
const POINTS_PER_LINE: f64 = 50.0;

/// Remembers the buttons that went down over the view: they belong to it until they go up, anywhere.
#[derive(Debug, Default)]
pub struct Input {
    held: Vec<PointerButton>,
    inside: bool,
    /// The time since when the pointer has rested over the view, until the editor gets the event.
    still_since: Option<Instant>,
    /// Digits of the numeric pad that went down and have not been handled yet.
    pub numpad: VecDeque<u8>,
}

/// After this time the resting pointer refers to the part under it.
const RESTS_AFTER: Duration = Duration::from_millis(120);

/// The receivers of the present events.
#[derive(Clone, Copy, Debug)]
pub struct Attention {
    /// The view's rectangle in the window, in points.
    pub rect: Rect,
    /// The pointer's last known place in the window, in points.
    pub pointer: egui::Pos2,
    /// True if the pointer is over the view and nothing covers it.
    pub pointer_over: bool,
    /// True if a transform follows the pointer wherever it goes, over panels and bars too.
    pub follows_pointer: bool,
    /// True if keys are for the view: no field has the keyboard and no question is open.
    pub keys: bool,
    /// True if events of this moment wait for the next frame.
    pub more_to_come: bool,
}

impl Input {
    /// The editor's events of this frame, in order.
    pub fn events(&mut self, context: &egui::Context, attention: Attention) -> Vec<Event> {
        let (events, modifiers) = context.input(|input| (input.events.clone(), input.modifiers));
        let mut out = Vec::new();
        for event in events {
            self.translate(&event, modifiers, attention, &mut out);
        }
        if !out.is_empty() {
            self.still_since = self.held.is_empty().then(Instant::now);
        }
        if let Some(still) = self.still_since.filter(|_| attention.pointer_over) {
            match RESTS_AFTER.checked_sub(still.elapsed()) {
                Some(wait) if !wait.is_zero() => context.request_repaint_after(wait),
                _ => {
                    self.still_since = None;
                    out.push(Event::PointerRested);
                }
            }
        }
        // Keys that went into a field are not commands.
        if !attention.more_to_come {
            self.numpad.clear();
        }
        if self.inside && !attention.pointer_over && !attention.follows_pointer && self.held.is_empty() {
            self.inside = false;
            out.push(Event::PointerLeft);
        }
        out
    }

    fn translate(
        &mut self,
        event: &egui::Event,
        modifiers: egui::Modifiers,
        attention: Attention,
        out: &mut Vec<Event>,
    ) {
        let pointer = |position, modifiers| attention.pointer_at(position, modifiers);
        let over = attention.pointer_over || attention.follows_pointer || !self.held.is_empty();
        match *event {
            egui::Event::PointerMoved(position) if over => {
                self.inside = true;
                out.push(Event::PointerMoved(pointer(position, modifiers)));
            }
            egui::Event::PointerButton {
                pos,
                button,
                pressed: true,
                modifiers,
            } if attention.pointer_over => {
                if let Some(ours) = button_of(button) {
                    self.held.push(button);
                    out.push(Event::PointerPressed(pointer(pos, modifiers), ours));
                }
            }
            egui::Event::PointerButton {
                pos,
                button,
                pressed: false,
                modifiers,
            } if self.held.contains(&button) => {
                self.held.retain(|&held| held != button);
                if let Some(ours) = button_of(button) {
                    out.push(Event::PointerReleased(pointer(pos, modifiers), ours));
                }
            }
            egui::Event::Touch { force, .. } => out.push(Event::Pressure(force.map(f64::from))),
            egui::Event::PointerGone if self.held.is_empty() && self.inside => {
                self.inside = false;
                out.push(Event::PointerLeft);
            }
            egui::Event::MouseWheel {
                unit, delta, modifiers, ..
            } if attention.pointer_over => {
                out.push(Event::Wheel {
                    pointer: pointer(attention.pointer, modifiers),
                    lines: f64::from(delta.y) * lines_of(unit),
                });
            }
            egui::Event::Zoom(factor) if attention.pointer_over => {
                let pointer = pointer(attention.pointer, modifiers);
                out.push(Event::Pinch {
                    pointer,
                    factor: f64::from(factor),
                });
            }
            egui::Event::Key {
                key,
                physical_key,
                pressed: true,
                modifiers,
                ..
            } if attention.keys => {
                let numpad = self.take_numpad(physical_key.unwrap_or(key));
                if let Some(key) = numpad.or_else(|| key_of(key)) {
                    out.push(Event::Key(key, held_modifiers(modifiers)));
                }
            }
            egui::Event::Key {
                key, pressed: false, ..
            } => out.extend(key_of(key).map(Event::KeyReleased)),
            _ => {}
        }
    }

    /// The key as one of the numeric pad, if its digit went down there.
    fn take_numpad(&mut self, physical_key: egui::Key) -> Option<Key> {
        let digit = digit_of(physical_key).filter(|digit| self.numpad.front() == Some(digit))?;
        self.numpad.pop_front();
        Some(Key::Numpad(digit))
    }
}

impl Attention {
    /// The editor's pointer at a position in the window, in points.
    fn pointer_at(&self, position: egui::Pos2, modifiers: egui::Modifiers) -> Pointer {
        let relative = position - self.rect.min;
        Pointer {
            position_px: DVec2::new(f64::from(relative.x), f64::from(relative.y)),
            modifiers: held_modifiers(modifiers),
        }
    }
}

/// The lines that one unit of a wheel scrolls.
fn lines_of(unit: MouseWheelUnit) -> f64 {
    match unit {
        MouseWheelUnit::Point => 1.0 / POINTS_PER_LINE,
        MouseWheelUnit::Line => 1.0,
        MouseWheelUnit::Page => 10.0,
    }
}

/// The key that went down in this frame, with its modifiers, if it is one that the editor knows.
pub fn pressed_key(input: &egui::InputState) -> Option<(Key, Modifiers)> {
    input.events.iter().find_map(|event| match event {
        egui::Event::Key {
            key,
            pressed: true,
            modifiers,
            ..
        } => Some((key_of(*key)?, held_modifiers(*modifiers))),
        _ => None,
    })
}

pub fn held_modifiers(modifiers: egui::Modifiers) -> Modifiers {
    Modifiers {
        shift: modifiers.shift,
        ctrl: modifiers.command,
        alt: modifiers.alt,
    }
}

fn button_of(button: PointerButton) -> Option<Button> {
    match button {
        PointerButton::Primary => Some(Button::Primary),
        PointerButton::Middle => Some(Button::Middle),
        PointerButton::Secondary => Some(Button::Secondary),
        PointerButton::Extra1 | PointerButton::Extra2 => None,
    }
}

/// The digit on a key, in either row.
fn digit_of(key: egui::Key) -> Option<u8> {
    key.symbol_or_name().parse::<u8>().ok().filter(|digit| *digit < 10)
}

pub fn key_of(key: egui::Key) -> Option<Key> {
    Some(match key {
        egui::Key::Escape => Key::Escape,
        egui::Key::Enter => Key::Enter,
        egui::Key::Backspace => Key::Backspace,
        egui::Key::Delete => Key::Delete,
        egui::Key::Home => Key::Home,
        egui::Key::Tab => Key::Tab,
        _ => Key::Character(character_of(key)?),
    })
}

/// The character a key types without modifiers, in lower case.
fn character_of(key: egui::Key) -> Option<char> {
    let mut characters = key.symbol_or_name().chars();
    match (characters.next(), characters.next(), key) {
        (_, _, egui::Key::Minus) => Some('-'),
        (_, _, egui::Key::Space) => Some(' '),
        (Some(character), None, _) if character.is_ascii() => Some(character.to_ascii_lowercase()),
        _ => None,
    }
}
