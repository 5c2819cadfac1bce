//! Handles followed through the frames of a sequence: their places, their footprints, and the motion of the body with its
//! bent path.

use std::collections::BTreeMap;

use glam::DVec3;
use pliant_editor::{
    BodyMotion, EditError, EditFile, FollowedHandle, FootprintEntry, Footprints, HandlePlace, PathPart,
    SequenceTimeline, Setup, middle_of,
};
use pliant_mesh::{Drawn, SurfaceVertex};

use super::bend::{followed, place};
use super::held::Held;
use super::side_by_side::side_by_side;
use super::source::Source;
use crate::EngineError;
use crate::loading::Loaded;
use crate::watch::Watch;

/// The handles of an edit, by number, and the ways in which it follows them.
pub(super) struct Handles<'a> {
    /// The vertices of each.
    pub vertices: &'a [Vec<SurfaceVertex>],
    /// The part whose middle makes the path of the body.
    pub path: Option<PathPart>,
    /// Those that another sequence leads.
    pub led: &'a [usize],
}

/// The handles in the frames that an edit needs.
pub(super) struct Followed {
    /// The place of each handle at rest, in the file whose vertices all frames have.
    rest: Vec<HandlePlace>,
    frames: BTreeMap<usize, OfFrame>,
    /// The motions of the body in all frames; none if its path is not bent.
    pub body: Vec<BodyMotion>,
}

struct OfFrame {
    /// Each handle.
    handles: Vec<FollowedHandle>,
    /// The place of each led handle in the other sequence.
    led: Vec<HandlePlace>,
    /// The middle of the part that makes the path of the body.
    middle: Option<DVec3>,
}

impl Followed {
    /// Reads the frames `needed` of a sequence and of the `other` one that leads handles of it.
    ///
    /// # Errors
    /// A frame that can't be read; [`EngineError::Interrupted`].
    pub fn of(
        needed: &[usize],
        mesh @ (first, _): (&Loaded, &Drawn),
        (source, other): (&Source, Option<&Source>),
        (edit, handles): (&EditFile, &Handles<'_>),
        watch: &Watch,
    ) -> Result<Self, EngineError> {
        let rest = &first.model.surface.positions;
        let place_in = |positions: &[DVec3], handle: usize| place(&handles.vertices[handle], rest, positions);
        let numbers = 0..handles.vertices.len();
        let of_frame = |frame: usize| -> Result<OfFrame, EngineError> {
            let positions = source.positions(frame, mesh, watch)?;
            let led = match other {
                None => Vec::new(),
                Some(other) => {
                    let theirs = other.positions(frame, mesh, watch)?;
                    handles.led.iter().map(|handle| place_in(&theirs, *handle)).collect()
                }
            };
            let own = handles.vertices.iter();
            let own: Vec<FollowedHandle> = own.map(|vertices| followed(vertices, rest, &positions)).collect();
            let of_frame = OfFrame {
                middle: handles.path.map(|part| match part {
                    PathPart::Body => middle_of(&positions),
                    PathPart::Handle(handle) => own[handle].place.centre(),
                }),
                handles: own,
                led,
            };
            Ok(of_frame)
        };
        let read = side_by_side(needed, of_frame, watch)?;
        let frames: BTreeMap<usize, OfFrame> = needed.iter().copied().zip(read).collect();
        let trajectory: Option<Vec<DVec3>> = frames.values().map(|frame| frame.middle).collect();
        let body = trajectory.map_or_else(Vec::new, |trajectory| edit.body_motions(&trajectory));
        Ok(Self {
            rest: numbers.map(|handle| place_in(rest, handle)).collect(),
            frames,
            body,
        })
    }

    /// The handles' motions by keys, filters and the other sequence.
    ///
    /// # Errors
    /// Those of [`EditFile::sequence_timeline`].
    pub fn timeline(&self, edit: &EditFile, setup: &Setup, led: &[usize]) -> Result<SequenceTimeline, EditError> {
        let places_of = |number: usize| self.frames.values().map(move |frame| frame.led[number]).collect();
        let led = led.iter().enumerate();
        let led = led.map(|(number, handle)| (*handle, places_of(number))).collect();
        edit.sequence_timeline(
            setup,
            &self.rest,
            |frame, handle| self.frames[&frame].handles[handle].place,
            led,
        )
    }

    /// The footprints. All frames were read if there are any.
    pub fn footprints(&self, entries: &[(usize, &FootprintEntry)]) -> Vec<Held> {
        let of_entry = |(handle, entry): &(usize, &FootprintEntry)| {
            let frames: Vec<FollowedHandle> = self.frames.values().map(|frame| frame.handles[*handle]).collect();
            Held {
                handle: *handle,
                footprints: Footprints::of(&entry.footprints(), &frames),
            }
        };
        entries.iter().map(of_entry).collect()
    }
}
