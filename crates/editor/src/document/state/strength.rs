//! The shown share of the edit.
//!
//! Handles and attachments always have the shown values, at any share; their full values are stored beside them until
//! something else moves one of them: then the shown values are the full ones.

use std::sync::Arc;

use super::Document;
use crate::document::handle::Handle;
use crate::document::strength::{Stance, Strength};

impl Document {
    /// The shown share of the motions of handles, control points and examples, 0 to 1.
    pub fn strength(&self) -> f64 {
        self.content.strength.as_ref().map_or(1.0, |strength| strength.share)
    }

    /// Shows a share (0 to 1) of the whole edit, which must be solved again.
    pub(crate) fn set_strength(&mut self, share: f64) {
        if share != self.strength() {
            self.unsettle();
            self.take_part(share);
        }
    }

    /// Moves handles and attachments to a share of their displacement, and stores the full values. The shape does not
    /// change.
    pub(crate) fn take_part(&mut self, share: f64) {
        if share == self.strength() {
            return;
        }
        let content = &self.content;
        let whole = content.strength.clone();
        let whole = whole.unwrap_or_else(|| Arc::new(Strength::whole(&content.handles, &content.attachments)));
        if !whole.attachments.is_empty() {
            self.set_attachments(whole.attachments_at(share, self.method()));
        }
        self.change_handles(|handles| {
            for handle in handles {
                if let Some(stance) = whole.handles.get(&handle.id) {
                    let part = stance.part(share, handle.pivot);
                    (handle.transform, handle.turn_deg) = (part.transform, part.turn_deg);
                }
            }
        });
        let is_part = share != 1.0;
        self.content.strength = is_part.then(|| {
            Arc::new(Strength {
                share,
                ..(*whole).clone()
            })
        });
    }

    /// The same document with handles and attachments in full.
    pub(crate) fn in_full(&self) -> Self {
        let mut document = self.clone();
        document.take_part(1.0);
        document
    }

    /// Returns true if the path of each handle from rest follows from its transform alone.
    pub(crate) fn goes_the_short_way(&self) -> bool {
        let mut handles = self.content.handles.iter();
        handles.all(|handle| Stance::of(handle).goes_the_short_way())
    }

    /// Makes the shown values the full ones.
    pub(crate) fn forget_strength(&mut self) {
        self.content.strength = None;
    }

    /// The same, if a handle differs from `before`, or no handle remains.
    pub(super) fn forget_strength_unless_handles_stay(&mut self, before: &[Handle]) {
        let stands = |handle: &Handle| (handle.pivot, Stance::of(handle));
        let stays = |handle: &Handle| match before.iter().find(|other| other.id == handle.id) {
            Some(other) => stands(other) == stands(handle),
            None => !handle.is_displaced(),
        };
        let handles = &self.content.handles;
        if handles.is_empty() || !handles.iter().all(stays) {
            self.forget_strength();
        }
    }

    pub(in crate::document) fn take_strength(&mut self) -> Option<Arc<Strength>> {
        self.content.strength.take()
    }

    pub(in crate::document) fn put_strength(&mut self, strength: Option<Arc<Strength>>) {
        self.content.strength = strength;
    }
}
