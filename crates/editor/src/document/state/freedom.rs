//! Handles and curves' points that are free along a direction.

use glam::DVec3;

use super::Document;
use crate::document::handle::{Handle, HandleId};
use crate::document::handle_line::HandleLine;
use crate::document::version::Aspect;

impl Document {
    /// The direction along which a handle slides, if it is free: the keys of a handle hold it.
    pub(crate) fn freedom(&self, id: HandleId) -> Option<DVec3> {
        let mut keys = self.content.animation.keys().iter();
        let is_keyed = keys.any(|key| key.has(id));
        self.handle(id).and_then(Handle::freedom).filter(|_| !is_keyed)
    }

    /// Moves free handles along their directions to where a solve has found them. Their targets stay the same, because a
    /// transform says nothing about its handle's place along the direction. Returns whether a handle has moved.
    pub(crate) fn slide_handles(&mut self, distances: &[(HandleId, f64)]) -> bool {
        // A part of the edit leaves the whole edit as it is.
        if distances.is_empty() || self.strength() != 1.0 {
            return false;
        }
        for (id, distance) in distances {
            let direction = self.freedom(*id);
            let mut handles = self.content.handles.iter_mut();
            if let (Some(direction), Some(handle)) = (direction, handles.find(|handle| handle.id == *id)) {
                handle.put(handle.transform.moved_by(direction * *distance));
            }
        }
        self.marks.mark(&[Aspect::Handles]);
        true
    }

    /// Moves the free points of curves to where a solve has found them, and holds them there. Returns whether there was
    /// one.
    pub(crate) fn hold_free_points(&mut self, lengths: &[(HandleId, f64)]) -> bool {
        let mut has_held = false;
        for handle in &mut self.content.handles {
            let curve = handle.line.as_ref().and_then(HandleLine::curve);
            let Some(free) = curve.filter(|curve| curve.free_point().is_some()) else {
                continue;
            };
            let length = lengths
                .iter()
                .find(|(id, _)| *id == handle.id)
                .map_or(0.0, |(_, length)| *length);
            let held = free.slid(length).unwrap_or_else(|| free.clone().freed_at(None));
            handle.line = Some(HandleLine::Curve(held));
            has_held = true;
        }
        if has_held {
            self.marks.mark(&[Aspect::Handles]);
        }
        has_held
    }
}
