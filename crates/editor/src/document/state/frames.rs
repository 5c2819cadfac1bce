//! The frames of a sequence: each is the rest shape while it is shown.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::Document;
use crate::document::frame_place::FramePlace;
use crate::document::handle::HandleId;
use crate::document::handle_transform::HandleTransform;
use crate::document::version::Aspect;

impl Document {
    /// Shows a frame, whose surface is `shape` away from the file's: it becomes the rest shape. Handles go to their
    /// `places` in it, and those without one come to rest. The present bend stays until the frame is solved.
    pub(crate) fn put_frame(&mut self, frame: usize, shape: &Arc<Vec<DVec3>>, places: &BTreeMap<HandleId, FramePlace>) {
        let content = &mut self.content;
        content.animation = content.animation.at_frame(frame);
        content.strength = None;
        let is_other = !Arc::ptr_eq(&content.rest, shape);
        if is_other {
            content.rest = Arc::clone(shape);
            content.applied = shape.iter().any(|way| *way != DVec3::ZERO);
            self.marks.mark(&[Aspect::Rest]);
        }
        let targets = self.versions().of(Aspect::Targets);
        self.change_handles(|handles| {
            for handle in handles {
                let Some(place) = places.get(&handle.id) else {
                    handle.put(HandleTransform::IDENTITY);
                    continue;
                };
                handle.pivot = place.pivot;
                handle.put(place.transform);
                handle.held.clone_from(&place.held);
            }
        });
        let is_moved = is_other || self.versions().of(Aspect::Targets) != targets;
        if is_moved {
            self.content.kept = None;
            self.content.corrections = None;
        }
        if !self.is_moved() {
            self.unbend();
        } else if is_moved {
            self.content.sum_shapes();
            self.marks.mark(&[Aspect::Drawn]);
            self.unsettle();
        }
    }

    /// The document at the file's own shape, which is `file`, with its handles at their `places`.
    pub(crate) fn at_file(&self, file: &Arc<Vec<DVec3>>, places: &BTreeMap<HandleId, FramePlace>) -> Self {
        let mut document = self.clone();
        document.put_frame(self.content.animation.frame(), file, places);
        document
    }
}
