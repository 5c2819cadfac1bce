//! The frames of a sequence: the one that a person wants to see is asked for, and becomes the document's rest shape when
//! it was read. Until then the last one stays.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::state::Workspace;
use crate::document::{FramePlace, HandleId, HandleTransform, SavedAs};
use crate::timeline::{HandlePlace, places_of_handles};

/// The name of the step to another frame. Steps that follow each other become one.
const GO_TO_FRAME: &str = "Go to frame";

/// The frames on their way to the document.
#[derive(Default)]
pub(crate) struct FrameWork {
    /// The frame that a person wants to see; `None` if it is shown.
    wanted: Option<usize>,
    /// True before the first frame is shown, which is no step of the history.
    is_beginning: bool,
    /// A frame that was read, and its displacements from the file's shape.
    read: Option<(usize, Arc<Vec<DVec3>>)>,
}

impl FrameWork {
    /// Forgets the wanted frame.
    pub(super) fn stop(&mut self) {
        *self = Self::default();
    }

    /// Returns true between the wish for a frame and its arrival.
    pub(super) fn is_awaited(&self) -> bool {
        self.wanted.is_some()
    }
}

impl Workspace {
    /// The opened file is a frame of a sequence of so many frames.
    pub(crate) fn open_sequence(&mut self, count: usize, shown: Option<usize>) {
        let animation = self.document.animation().of_sequence(count);
        let shown = shown.unwrap_or(animation.frame());
        self.document.set_animation(animation.at_frame(0));
        self.history.needs(SavedAs::Project);
        self.frames = FrameWork {
            is_beginning: true,
            ..FrameWork::default()
        };
        self.frames.wanted = Some(shown);
    }

    /// Wants a frame to be shown, or the last one if there are fewer.
    pub(super) fn want_frame(&mut self, frame: usize) {
        let animation = self.document.animation();
        let frame = animation.at_frame(frame).frame();
        self.frames.wanted = (frame != animation.frame()).then_some(frame);
    }

    /// Returns true between the wish for a frame and its arrival.
    pub(crate) fn awaits_frame(&self) -> bool {
        self.frames.is_awaited()
    }

    /// The frame that must be read next; `None` if there is none.
    pub(crate) fn frame_to_read(&self) -> Option<usize> {
        let wanted = self.frames.wanted?;
        let is_read = self.frames.read.as_ref().is_some_and(|(frame, _)| *frame == wanted);
        (!is_read).then_some(wanted)
    }

    /// Takes a frame that was read, or the reason why it was not.
    pub(crate) fn take_frame(&mut self, frame: usize, shape: Result<Arc<Vec<DVec3>>, String>) {
        let is_awaited = self.frame_to_read() == Some(frame);
        match shape {
            Ok(shape) if shape.len() == self.document.rest().len() => self.frames.read = Some((frame, shape)),
            Ok(_) => {}
            Err(sentence) if is_awaited => {
                self.frames.stop();
                self.pause_keys();
                self.refuse(sentence);
            }
            Err(_) => {}
        }
    }

    /// Shows the wanted frame if it was read.
    pub(crate) fn show_wanted_frame(&mut self) {
        let Some(wanted) = self.frames.wanted else { return };
        let Some((_, shape)) = self.frames.read.take_if(|(frame, _)| *frame == wanted) else {
            return;
        };
        self.frames.wanted = None;
        let is_first = std::mem::take(&mut self.frames.is_beginning) && self.history.names().0.is_empty();
        if is_first || self.keys.is_playing() {
            return self.put_frame(wanted, &shape);
        }
        if !self.is_adjusting() && self.history.undo_name() == Some(GO_TO_FRAME) {
            self.history.undo(&mut self.document);
        }
        self.step(GO_TO_FRAME, |workspace| workspace.put_frame(wanted, &shape));
    }

    fn put_frame(&mut self, frame: usize, shape: &Arc<Vec<DVec3>>) {
        let places = self.frame_places(shape);
        self.document.put_frame(frame, shape, &places);
    }

    /// Each handle's pivot and transform in a frame with this shape.
    fn frame_places(&self, shape: &[DVec3]) -> BTreeMap<HandleId, FramePlace> {
        let (before, now) = (self.places_in(self.document.rest()), self.places_in(shape));
        let handles = self.document.handles().iter();
        let place = handles.filter_map(|handle| {
            let pivot = now.get(&handle.id)?.carried(handle.pivot, before.get(&handle.id)?);
            Some((handle.id, (pivot, HandleTransform::IDENTITY)))
        });
        place.collect()
    }

    /// The place of each handle where the surface is so far from the file's.
    fn places_in(&self, way: &[DVec3]) -> BTreeMap<HandleId, HandlePlace> {
        let file = self.model().map_or(&[][..], |model| &model.surface.positions);
        places_of_handles(self.document.paint(), file, way)
    }
}
