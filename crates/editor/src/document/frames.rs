//! The animation of a sequence: its keys are at frames, of which one is shown.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec3;

use super::animation::Animation;
use super::body_path::BodyPath;
use super::handle::HandleId;
use super::handle_filter::HandleFilter;
use super::handle_footprints::HandleFootprints;
use super::handle_mix::HandleMix;
use super::key_id::KeyId;
use crate::ground_axis::GroundAxis;

impl Animation {
    /// The same keys for the frames of a sequence, of which one is shown.
    pub(crate) fn of_sequence(&self, count: usize) -> Self {
        let mut animation = Self {
            frames: Some(count.max(1)),
            ..self.clone()
        };
        animation.tidy_spans();
        animation.path = animation
            .path
            .and_then(|path| path.only(|frame| frame < count))
            .map(Arc::new);
        let last = count.max(1) - 1;
        for filter in Arc::make_mut(&mut animation.filters).values_mut() {
            filter.span = filter.span.map(|frame| frame.min(last));
        }
        animation.at_frame(self.frame_at(self.time).round() as usize)
    }

    /// The number of frames of the sequence that is edited; `None` for an edit of one shape.
    pub fn frames(&self) -> Option<usize> {
        self.frames
    }

    /// The shown frame of a sequence, from 0.
    pub fn frame(&self) -> usize {
        self.frame_at(self.time).round() as usize
    }

    /// The same animation at another frame, or at the last one if there are fewer.
    pub(crate) fn at_frame(&self, frame: usize) -> Self {
        let last = self.frames.map_or(frame, |count| count - 1);
        Self {
            time: frame.min(last) as f64 / self.fps,
            ..self.clone()
        }
    }

    /// The same animation with other frames a second. Keys keep their times, and those of a sequence their frames.
    pub(crate) fn with_fps(&self, fps: f64) -> Self {
        let mut animation = Self { fps, ..self.clone() };
        if self.frames.is_some() {
            let moved = |time: f64| self.frame_at(time).round() / fps;
            animation.time = moved(self.time);
            for key in Arc::make_mut(&mut animation.keys) {
                key.time = moved(key.time);
            }
        }
        animation
    }

    /// The bent path of the sequence's body; `None` if it is the body's own.
    pub fn path(&self) -> Option<&Arc<BodyPath>> {
        self.path.as_ref()
    }

    /// The same animation with another path.
    pub(crate) fn with_path(&self, path: Option<BodyPath>) -> Self {
        Self {
            path: path.map(Arc::new),
            ..self.clone()
        }
    }

    /// Moves the body at a frame of the sequence. The first such frame brings both ends of the sequence, at which the body
    /// stays.
    pub(crate) fn bend_path(&self, frame: usize, shift: DVec3, up: GroundAxis) -> Self {
        let path = match self.path() {
            Some(path) => Some(path.with(frame, shift)),
            None => {
                let last = self.frames.map_or(0, |count| count - 1);
                let mut shifts = BTreeMap::from([0, last].map(|end| (end, DVec3::ZERO)));
                shifts.insert(frame, shift);
                BodyPath::of(shifts, up)
            }
        };
        self.with_path(path)
    }

    /// No longer moves the body at a frame. With fewer than two such frames the path is the body's own.
    pub(crate) fn free_path(&self, frame: usize) -> Self {
        self.with_path(self.path().and_then(|path| path.only(|own| own != frame)))
    }

    /// The filters of handles' ways.
    pub fn filters(&self) -> &Arc<BTreeMap<HandleId, HandleFilter>> {
        &self.filters
    }

    /// The same animation with another filter of a handle's way, or without one.
    pub(crate) fn with_filter(&self, handle: HandleId, filter: Option<HandleFilter>) -> Self {
        let mut filters = (*self.filters).clone();
        match filter {
            Some(filter) => filters.insert(handle, filter),
            None => filters.remove(&handle),
        };
        Self {
            filters: Arc::new(filters),
            ..self.clone()
        }
    }

    /// The handles that are held wherever they rest on the ground.
    pub fn footprints(&self) -> &Arc<BTreeMap<HandleId, HandleFootprints>> {
        &self.footprints
    }

    /// The same animation with other footprints of a handle, or without any.
    pub(crate) fn with_footprints(&self, handle: HandleId, footprints: Option<HandleFootprints>) -> Self {
        let mut all = (*self.footprints).clone();
        match footprints {
            Some(footprints) => all.insert(handle, footprints),
            None => all.remove(&handle),
        };
        Self {
            footprints: Arc::new(all),
            ..self.clone()
        }
    }

    /// The sequence that leads handles; `None` if none does.
    pub fn mix(&self) -> Option<&Arc<HandleMix>> {
        self.mix.as_ref()
    }

    /// The same animation with another sequence that leads handles, or with none.
    pub(crate) fn with_mix(&self, mix: Option<HandleMix>) -> Self {
        Self {
            mix: mix.filter(|mix| !mix.handles.is_empty()).map(Arc::new),
            ..self.clone()
        }
    }

    /// Drops the keys of handles that nothing else moves: those with footprints, and those that another sequence leads.
    pub(crate) fn drop_useless_keys(&mut self) {
        let is_held = |id: &KeyId| {
            let Some(handle) = id.row.handle() else { return false };
            let is_led = self.mix.as_ref().is_some_and(|mix| mix.leads(handle));
            is_led || self.footprints.contains_key(&handle)
        };
        let held: BTreeSet<KeyId> = self.ids().filter(is_held).collect();
        self.take(&held);
    }
}
