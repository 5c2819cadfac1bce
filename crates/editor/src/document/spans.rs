//! The spans of a sequence's keys: the frames over which each key spreads. Keys of a handle share a span, or their spans
//! do not meet.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::animation::{Animation, KeyFrame};
use super::handle::HandleId;
use super::key_id::KeyId;
use crate::key_space::KeySpace;

/// The frames on each side of a new key over which it spreads.
const HALF: usize = 12;

impl KeyFrame {
    /// The first and the last frame over which the key of a handle spreads; `None` outside sequences.
    pub fn span(&self, handle: HandleId) -> Option<[usize; 2]> {
        self.spans.get(&handle).copied()
    }

    /// Moves its spans by so many frames; none begins before 0.
    pub(crate) fn shift_spans(&mut self, by: isize) {
        for end in self.spans.values_mut().flatten() {
            *end = end.saturating_add_signed(by);
        }
    }
}

impl Animation {
    /// The span of a handle's keys that holds a frame.
    pub(crate) fn span_at(&self, handle: HandleId, frame: usize) -> Option<[usize; 2]> {
        span_of(self.keys().iter().filter_map(|key| key.span(handle)), frame)
    }

    /// The keys of a handle in one of its spans, with their frames.
    pub(crate) fn keys_in(&self, handle: HandleId, span: [usize; 2]) -> impl Iterator<Item = (usize, &KeyFrame)> {
        let own = self.keys().iter().filter(move |key| key.span(handle) == Some(span));
        own.map(|key| (self.frame_of(key), key))
    }

    /// The frame of a sequence's key.
    pub fn frame_of(&self, key: &KeyFrame) -> usize {
        self.frame_at(key.time).round() as usize
    }

    /// Changes the span that holds a key. It goes on to hold all of its keys, and stops before other spans of the handle.
    pub(crate) fn set_span(&mut self, id: KeyId, to: [usize; 2]) {
        let frame = self.frame_at(id.time()).round() as usize;
        let Some(handle) = id.row.handle() else { return };
        let Some(from) = self.span_at(handle, frame) else {
            return;
        };
        let frames = self.keys_in(handle, from).map(|(frame, _)| frame);
        let (first, last) = frames.fold((frame, frame), |(first, last), own| (first.min(own), last.max(own)));
        let others = self.keys().iter().filter_map(|key| key.span(handle));
        let others: Vec<[usize; 2]> = others.filter(|span| *span != from).collect();
        let [least, most] = self.room(first, last, &others);
        let to = [to[0].clamp(least, first), to[1].clamp(last, most)];
        for key in Arc::make_mut(&mut self.keys) {
            if let Some(span) = key.spans.get_mut(&handle).filter(|span| **span == from) {
                *span = to;
            }
        }
    }

    /// Gives new keys of a sequence their spans, and keys whose spans meet one that holds both.
    pub(crate) fn tidy_spans(&mut self) {
        let Some(count) = self.frames() else { return };
        let handles: BTreeSet<HandleId> = self.keys().iter().flat_map(KeyFrame::handles).collect();
        for handle in handles {
            let keys = self.keys().iter().filter(|key| key.has(handle));
            let own: Vec<(usize, Option<[usize; 2]>)> =
                keys.map(|key| (self.frame_of(key), key.span(handle))).collect();
            let known = own.iter().filter_map(|(frame, span)| {
                let [first, last] = (*span)?;
                Some([first.min(*frame), last.max(*frame).min(count - 1)])
            });
            let mut spans = joined(known.collect());
            for (frame, _) in own.iter().filter(|(_, span)| span.is_none()) {
                if span_of(spans.iter().copied(), *frame).is_none() {
                    let [least, most] = self.room(*frame, *frame, &spans);
                    spans.push([frame.saturating_sub(HALF).max(least), (frame + HALF).min(most)]);
                }
            }
            let frames: Vec<usize> = self.keys().iter().map(|key| self.frame_of(key)).collect();
            for (key, frame) in Arc::make_mut(&mut self.keys).iter_mut().zip(frames) {
                match span_of(spans.iter().copied(), frame).filter(|_| key.has(handle)) {
                    Some(span) => key.spans.insert(handle, span),
                    None => key.spans.remove(&handle),
                };
            }
            // A key that comes to others takes their axes on.
            for span in spans {
                if self
                    .keys_in(handle, span)
                    .any(|(_, key)| key.in_world.contains(&handle))
                {
                    self.put_span_into(handle, span, KeySpace::World);
                }
            }
        }
    }

    /// Chooses the axes in which keys of a sequence stay the same, with all keys of their spans.
    pub(crate) fn set_space(&mut self, ids: &BTreeSet<KeyId>, space: KeySpace) {
        for id in ids {
            let Some(handle) = id.row.handle() else { continue };
            let frame = self.frame_at(id.time()).round() as usize;
            if let Some(span) = self.span_at(handle, frame) {
                self.put_span_into(handle, span, space);
            }
        }
    }

    fn put_span_into(&mut self, handle: HandleId, span: [usize; 2], space: KeySpace) {
        for key in Arc::make_mut(&mut self.keys) {
            if key.span(handle) == Some(span) {
                match space {
                    KeySpace::World => key.in_world.insert(handle),
                    KeySpace::Local => key.in_world.remove(&handle),
                };
            }
        }
    }

    /// The frames that a span around some frames can have between the other spans of its handle.
    fn room(&self, first: usize, last: usize, others: &[[usize; 2]]) -> [usize; 2] {
        let before = others.iter().filter(|span| span[1] < first).map(|span| span[1] + 1);
        let after = others.iter().filter(|span| span[0] > last).map(|span| span[0] - 1);
        let end = self.frames().map_or(last, |count| count - 1);
        [before.max().unwrap_or(0), after.min().unwrap_or(end)]
    }
}

/// The spans, with those that meet as one.
fn joined(mut spans: Vec<[usize; 2]>) -> Vec<[usize; 2]> {
    spans.sort_unstable();
    let mut joined: Vec<[usize; 2]> = Vec::new();
    for span in spans {
        match joined.last_mut() {
            Some(before) if span[0] <= before[1] => before[1] = before[1].max(span[1]),
            _ => joined.push(span),
        }
    }
    joined
}

/// The span that holds a frame.
fn span_of(mut spans: impl Iterator<Item = [usize; 2]>, frame: usize) -> Option<[usize; 2]> {
    spans.find(|span| (span[0]..=span[1]).contains(&frame))
}
