//! The ghosts of other moments: those of an edit of one shape are solved from its keys, and those of a sequence are its
//! frames, each with the edit on its own shape.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_deform::Solve;

use super::skin_frames::SkinFrame;
use super::state::Workspace;
use crate::document::{Animation, Aspect, Handle, HandleId};
use crate::jobs::{Activity, FrameSkin};
use crate::timeline::present_key;
use crate::view::Look;

/// Handles that are closer than this, as a share of their distance from the origin, are at one place.
const ROUNDING: f64 = 1e-9;

impl Workspace {
    /// Requests the ghosts that the look shows. None is shown while the animation plays. Those of an iterative method and
    /// of a sequence follow once the shape rests.
    pub(crate) fn follow_skins(&mut self, look: &Look, activity: Activity) {
        let animation = self.document.animation();
        let is_shown = look.timeline && look.skins.shown && animation.duration() > 0.0 && !self.keys.is_playing();
        let is_sequence = animation.frames().is_some();
        let moments = match is_shown {
            true => look.skins.moments(animation, self.document.rest().len()),
            false => Vec::new(),
        };
        if !is_shown {
            self.jobs.forget_skins();
        }
        let is_at_rest = activity == Activity::Still && self.document.is_settled();
        if is_sequence {
            return self.follow_frame_skins(&moments, is_at_rest && !self.is_adjusting());
        }
        let is_live = self.document.method().solve() == Solve::Direct;
        let is_other_problem = self.document.versions().are_other_problem(&self.seen);
        if is_shown && (is_live || is_at_rest) && activity != Activity::Painting && !is_other_problem {
            self.jobs.follow_skins(moments, &self.document);
        }
    }

    /// Requests the ghosts of a sequence's frames: first the frames, one after the other, then their shapes. While the
    /// edit or the frame changes, nothing is read or solved for them, and the last ones stay.
    fn follow_frame_skins(&mut self, moments: &[(i8, f64)], is_at_rest: bool) {
        let animation = self.document.animation();
        let frames: Vec<(i8, usize)> = moments
            .iter()
            .map(|(place, time)| (*place, animation.frame_at(*time).round() as usize))
            .collect();
        self.frames.skins.want(&frames);
        if frames.is_empty() {
            return;
        }
        let is_waiting = self.frames.is_awaited() || self.document.versions().are_other_problem(&self.seen);
        if !is_at_rest || is_waiting {
            return self.jobs.pause_skins();
        }
        if self.awaits_handles() || self.asks_for_skins(&frames) {
            return;
        }
        let knows_way = !self.frames.way.is_unknown();
        if self.jobs.wants_frame_skins(&frames, knows_way, &self.document) {
            let skins = self.frame_skins(&frames);
            self.jobs.follow_frame_skins((frames, knows_way), skins, &self.document);
        }
    }

    /// Asks for the next frame that the ghosts in these frames need. Returns false if all are known.
    fn asks_for_skins(&mut self, frames: &[(i8, usize)]) -> bool {
        let paint = self.document.versions().of(Aspect::Paint);
        for (_, frame) in frames {
            let needed = match self.frames.skins.get(*frame, paint) {
                None => Some(*frame),
                Some(Some(_)) => self.unknown_frame(*frame),
                Some(None) => continue,
            };
            if let Some(needed) = needed {
                self.frames.skins.ask(needed, *frame);
                return true;
            }
            if self.awaits_mix(*frame) {
                self.frames.skins.ask_mix(*frame);
                return true;
            }
        }
        false
    }

    /// Takes the frame that was asked for.
    pub(super) fn take_skin_frame(&mut self, frame: usize, shape: Arc<Vec<DVec3>>) {
        let read = SkinFrame {
            places: Arc::new(self.places_in(&shape)),
            paint: self.document.versions().of(Aspect::Paint),
            shape,
        };
        self.frames.skins.take(frame, read);
    }

    /// The ghosts in frames that are known.
    fn frame_skins(&self, frames: &[(i8, usize)]) -> Vec<FrameSkin> {
        let document = &self.document;
        let paint = document.versions().of(Aspect::Paint);
        let before = self.places_in(document.rest());
        let animation = self.with_present_key();
        let motion = |frame: usize| self.frames.way.motion(frame).filter(|_| animation.path().is_some());
        let skin = |(place, frame): &(i8, usize)| {
            let read = self.frames.skins.get(*frame, paint)??;
            Some(FrameSkin {
                place: *place,
                frame: *frame,
                shape: Arc::clone(&read.shape),
                places: self.places_by(&animation, Some(*frame), &read.shape, (&before, &read.places)),
                motions: motion(*frame).zip(motion(animation.frame())),
            })
        };
        frames.iter().filter_map(skin).collect()
    }

    /// The document's keys, and the one that *Key here* would set in the shown frame, if a handle is not where the keys
    /// have it.
    fn with_present_key(&self) -> Animation {
        let document = &self.document;
        let mut animation = document.animation().clone();
        let keyed = self.frame_places(Some(animation.frame()), document.rest());
        let is_left = |handle: &Handle| {
            keyed.get(&handle.id).is_some_and(|place| {
                let mut there = handle.clone();
                there.pivot = place.pivot;
                there.put(place.transform);
                are_apart(&there.affine(), &handle.affine(), handle.pivot)
            })
        };
        let left: Vec<HandleId> = document
            .handles()
            .iter()
            .filter(|handle| is_left(handle))
            .map(|handle| handle.id)
            .collect();
        if !left.is_empty() {
            let mut key = present_key(document, |id| left.contains(&id));
            self.without_filters(&mut key);
            animation.put(key);
            animation.tidy_spans();
        }
        animation
    }
}

/// Returns true if two maps differ around a point by more than rounding: pivots ride along from one shown frame to the
/// next.
fn are_apart(a: &DAffine3, b: &DAffine3, around: DVec3) -> bool {
    let (place, other) = (a.transform_point3(around), b.transform_point3(around));
    let size = around.length().max(place.length());
    place.distance(other) > ROUNDING * size || !a.matrix3.abs_diff_eq(b.matrix3, ROUNDING)
}
