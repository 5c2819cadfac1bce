//! The frames of a sequence: the one that a person wants to see is asked for, and becomes the document's rest shape when
//! it was read. Until then the last one stays.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::frame_work::FrameWork;
use super::state::Workspace;
use crate::document::{Animation, Aspect, Document, FramePlace, Handle, HandleId, HandleTransform, SavedAs};
use crate::timeline::{HandlePlace, frames_that_reach, places_of_handles, transform_at};

/// The name of the step to another frame. Steps that follow each other become one.
const GO_TO_FRAME: &str = "Go to frame";

impl Workspace {
    /// The opened file is a frame of a sequence of so many frames, which is played at `fps` frames a second.
    pub(crate) fn open_sequence(&mut self, count: usize, shown: Option<usize>, fps: Option<f64>) {
        let animation = self.document.animation().of_sequence(count);
        let animation = fps
            .filter(|fps| Animation::FPS_RANGE.contains(fps))
            .map_or_else(|| animation.clone(), |fps| animation.with_fps(fps));
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
        self.frame_to_show().or(self.frames.skins.asked())
    }

    /// The frame that must be read before the wanted one is shown.
    fn frame_to_show(&self) -> Option<usize> {
        let wanted = self.frames.wanted?;
        let is_read = self.frames.read.as_ref().is_some_and(|(frame, _)| *frame == wanted);
        match is_read {
            true => self.unknown_frame(wanted),
            false => Some(wanted),
        }
    }

    /// A frame with a key or a footprint that reaches this one, in which the handles are not known.
    pub(super) fn unknown_frame(&self, frame: usize) -> Option<usize> {
        let document = &self.document;
        let is_known = |needed: &usize| {
            let is_current = self.frames.places_of == Some(document.versions().of(Aspect::Paint));
            is_current && self.frames.places.contains_key(needed)
        };
        let mut needed = frames_that_reach(document.animation(), document.handles(), frame).into_iter();
        let of_keys = needed.find(|needed| *needed != frame && !is_known(needed));
        of_keys.or_else(|| self.frames.footprints.unknown_in(frame))
    }

    /// Notes the handles in a frame that has a key, or whose footprint reaches the wanted frame.
    fn note_handles(&mut self, frame: usize, shape: &[DVec3]) {
        let paint = self.document.versions().of(Aspect::Paint);
        if self.frames.places_of.replace(paint) != Some(paint) {
            self.frames.places.clear();
        }
        let animation = self.document.animation();
        let has_key = animation.keys().iter().any(|key| animation.frame_of(key) == frame);
        if has_key && !self.frames.places.contains_key(&frame) {
            let places = self.places_in(shape);
            self.frames.places.insert(frame, places);
        }
        let wanted = self.frames.wanted.unwrap_or(self.document.animation().frame());
        let wanted: Vec<usize> = self.frames.skins.frames().chain([wanted]).collect();
        let mut footprints = std::mem::take(&mut self.frames.footprints);
        footprints.note(frame, &wanted, || self.held_shapes(shape));
        self.frames.footprints = footprints;
    }

    /// Takes a frame that was read, or the reason why it was not.
    pub(crate) fn take_frame(&mut self, frame: usize, shape: Result<Arc<Vec<DVec3>>, String>) {
        let is_awaited = self.frame_to_show() == Some(frame);
        match shape {
            Ok(shape) if shape.len() == self.document.rest().len() => {
                self.note_handles(frame, &shape);
                // A frame that was read for its handles' places is not shown.
                if self.frames.wanted == Some(frame) {
                    self.frames.read = Some((frame, shape));
                } else if self.frames.skins.asked() == Some(frame) {
                    self.take_skin_frame(frame, shape);
                }
            }
            Ok(_) => {}
            Err(sentence) if is_awaited => {
                self.frames.stop();
                self.pause_keys();
                self.refuse(sentence);
            }
            Err(_) => self.frames.skins.fail(frame),
        }
    }

    /// Shows the wanted frame if it was read.
    pub(crate) fn show_wanted_frame(&mut self) {
        let Some(wanted) = self.frames.wanted else { return };
        self.follow_filters();
        if self.frame_to_show().is_some() || self.awaits_handles() || self.awaits_mix(wanted) {
            return;
        }
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

    /// Wants the frame so many after the shown or wanted one.
    pub(super) fn step_frames(&mut self, frames: i32) {
        let now = self.frames.wanted.unwrap_or(self.document.animation().frame());
        self.want_frame(now.saturating_add_signed(frames as isize));
    }

    /// Brings the handles in the shown frame to where the keys have them, in the present step if all is known.
    pub(super) fn pose_frame(&mut self) {
        self.follow_filters();
        let (frame, shape) = (self.document.animation().frame(), Arc::clone(&self.document.rest));
        self.note_handles(frame, &shape);
        match self.unknown_frame(frame).is_none() && !self.awaits_handles() && !self.awaits_mix(frame) {
            true => self.put_frame(frame, &shape),
            false if self.frames.wanted.is_none() => {
                self.frames.wanted = Some(frame);
                self.frames.read = Some((frame, shape));
            }
            // It is brought there with the next frame.
            false => {}
        }
    }

    fn put_frame(&mut self, frame: usize, shape: &Arc<Vec<DVec3>>) {
        self.note_handles(frame, shape);
        let places = self.frame_places(Some(frame), shape);
        let document = &mut self.document;
        document.put_frame(frame, shape, &places);
        if !document.is_settled() {
            self.jobs.solve_anew(document.versions().of(Aspect::Targets));
        }
    }

    /// The document at the file's own shape with its handles at rest, as files store it: the frames' shapes are in their
    /// own files.
    pub(crate) fn document_at_file(&self) -> Document {
        let places = self.frame_places(None, &self.original);
        self.document.at_file(&self.original, &places)
    }

    /// Each handle's pivot and transform in a frame with this shape; at rest without a frame.
    pub(super) fn frame_places(&self, frame: Option<usize>, shape: &[DVec3]) -> BTreeMap<HandleId, FramePlace> {
        let places = (&self.places_in(self.document.rest()), &self.places_in(shape));
        self.places_by(self.document.animation(), frame, shape, places)
    }

    /// The same by an animation, if the handles are at these places in the shown frame and in this one.
    pub(super) fn places_by(
        &self,
        animation: &Animation,
        frame: Option<usize>,
        shape: &[DVec3],
        (before, now): (&BTreeMap<HandleId, HandlePlace>, &BTreeMap<HandleId, HandlePlace>),
    ) -> BTreeMap<HandleId, FramePlace> {
        let document = &self.document;
        let shown = animation.frame();
        let held_in = frame.filter(|frame| self.frames.footprints.hold_in(*frame));
        let held_in = held_in.map(|frame| (frame, self.held_shapes(shape)));
        let place = |handle: &Handle| {
            let own = now.get(&handle.id)?;
            let pivot = match before.get(&handle.id)? {
                before if before == own => handle.pivot,
                before => own.carried(handle.pivot, before),
            };
            let transform = frame.map_or(HandleTransform::IDENTITY, |frame| {
                let place_at = |key: usize| match key == frame {
                    true => Some(*own),
                    false if key == shown => before.get(&handle.id).copied(),
                    false => self.frames.places.get(&key)?.get(&handle.id).copied(),
                };
                let mix = animation.mix();
                let paint = document.versions().of(Aspect::Paint);
                let led = mix.and_then(|mix| Some((self.frames.mix.place(handle.id, frame, (paint, mix))?, mix)));
                if let Some((led, mix)) = led {
                    return own.transform_to(led, mix.share, pivot);
                }
                let transform = transform_at(animation, handle, (frame, own, pivot), place_at);
                match self.frames.filters.shift(handle.id, frame) {
                    DVec3::ZERO => transform,
                    shift => transform.moved_by(shift),
                }
            });
            let (footprints, body) = (&self.frames.footprints, self.frames.way.motions());
            let held = held_in.as_ref();
            let held = held.and_then(|(frame, own)| footprints.held(handle.id, *frame, own, body));
            let place = FramePlace { pivot, transform, held };
            Some((handle.id, place))
        };
        document.handles().iter().filter_map(place).collect()
    }

    /// The place of each handle where the surface is so far from the file's.
    pub(super) fn places_in(&self, way: &[DVec3]) -> BTreeMap<HandleId, HandlePlace> {
        let file = self.model().map_or(&[][..], |model| &model.surface.positions);
        places_of_handles(self.document.paint(), file, way)
    }
}
