//! Events that wait: for the hierarchy of the drawn shape, or for the result of an outline. They keep their order.

use super::Editor;
use crate::event::Event;
use crate::input::{Button, Key};
use crate::jobs::JobKind;

/// The time in milliseconds after which the rest of the events that have waited goes on waiting, for the next frame.
const CATCHING_UP_MS: f64 = 8.0;

impl Editor {
    /// Whether events wait that can be handled.
    pub(super) fn is_catching_up(&self) -> bool {
        let jobs = &self.workspace.jobs;
        let answers = jobs.is_picking_current() || !jobs.is_busy(JobKind::Pick);
        answers && !self.waiting.is_empty() && !self.is_looking()
    }

    /// Handles the events that have waited, for a while: a whole stroke at once would hold up the window.
    pub(super) fn catch_up(&mut self) {
        let end_ms = self.workspace.jobs.now_ms() + CATCHING_UP_MS;
        while !self.is_looking()
            && let Some(event) = self.waiting.pop_front()
        {
            self.dispatch(event);
            self.conclude();
            if self.workspace.jobs.now_ms() >= end_ms {
                return;
            }
        }
    }

    pub(super) fn is_looking(&self) -> bool {
        self.gesture.as_ref().is_some_and(|gesture| gesture.is_looking())
    }

    /// Returns true if the event must wait: for the hierarchy of the drawn shape, for the result of an outline, or for
    /// events that wait already.
    pub(super) fn must_wait(&mut self, event: &Event) -> bool {
        let waits = !self.waiting.is_empty() || self.is_looking();
        match event {
            // The stroke that has begun ends where it ended.
            Event::PointerLeft if self.gesture.is_some() && self.is_catching_up() => true,
            Event::Key(Key::Escape, _) | Event::PointerLeft => {
                self.waiting.clear();
                false
            }
            Event::PointerMoved(_) | Event::PointerReleased(..) | Event::Wheel { .. } | Event::Key(..) => waits,
            Event::PointerPressed(pointer, button) => {
                let asks = *button == Button::Primary && !pointer.modifiers.alt && self.gesture.is_none();
                let jobs = &self.workspace.jobs;
                let is_late = asks && jobs.is_busy(JobKind::Pick) && !jobs.is_picking_current();
                waits
                    || (is_late
                        && self
                            .overlay
                            .grabbed(pointer.position_px, &self.view, &self.settings)
                            .is_none())
            }
            _ => false,
        }
    }
}
