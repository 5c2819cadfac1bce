//! Handles followed through the frames of a sequence: their places, the motion of the body with its bent path, and the
//! shapes of handles with footprints.

use std::collections::BTreeMap;

use glam::DVec3;
use pliant_editor::{
    BodyMotion, EditError, EditFile, FootprintEntry, Footprints, HandlePlace, PathPart, SequenceTimeline, Setup,
    middle_of,
};
use pliant_mesh::{Drawn, SurfaceVertex};

use super::bend::place;
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
    /// Those with footprints.
    pub footprints: &'a [(usize, &'a FootprintEntry)],
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
    body: Vec<BodyMotion>,
}

struct OfFrame {
    /// The place of each handle.
    places: Vec<HandlePlace>,
    /// The positions of the vertices of each handle with footprints, in their order.
    shapes: Vec<Vec<DVec3>>,
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
        let places = |positions: &[DVec3]| -> Vec<HandlePlace> {
            let numbers = 0..handles.vertices.len();
            numbers.map(|handle| place_in(positions, handle)).collect()
        };
        let of_frame = |frame: usize| -> Result<OfFrame, EngineError> {
            let positions = source.positions(frame, mesh, watch)?;
            let led = match other {
                None => Vec::new(),
                Some(other) => {
                    let theirs = other.positions(frame, mesh, watch)?;
                    handles.led.iter().map(|handle| place_in(&theirs, *handle)).collect()
                }
            };
            let shape = |(handle, _): &(usize, &FootprintEntry)| -> Vec<DVec3> {
                let vertices = handles.vertices[*handle].iter();
                vertices.map(|vertex| positions[vertex.index()]).collect()
            };
            let places = places(&positions);
            let of_frame = OfFrame {
                middle: handles.path.map(|part| match part {
                    PathPart::Body => middle_of(&positions),
                    PathPart::Handle(handle) => places[handle].centre(),
                }),
                places,
                shapes: handles.footprints.iter().map(shape).collect(),
                led,
            };
            Ok(of_frame)
        };
        let read = side_by_side(needed, of_frame, watch)?;
        let frames: BTreeMap<usize, OfFrame> = needed.iter().copied().zip(read).collect();
        let trajectory: Option<Vec<DVec3>> = frames.values().map(|frame| frame.middle).collect();
        let body = trajectory.map_or_else(Vec::new, |trajectory| edit.body_motions(&trajectory));
        Ok(Self {
            rest: places(rest),
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
            |frame, handle| self.frames[&frame].places[handle],
            led,
        )
    }

    /// The footprints and the motions of the body. All frames were read if there are footprints.
    pub fn footprints(self, entries: &[(usize, &FootprintEntry)]) -> (Vec<Held>, Vec<BodyMotion>) {
        let mut shapes: Vec<Vec<Vec<DVec3>>> = vec![Vec::new(); entries.len()];
        for of_frame in self.frames.into_values() {
            for (shapes, shape) in shapes.iter_mut().zip(of_frame.shapes) {
                shapes.push(shape);
            }
        }
        let pairs = entries.iter().zip(&shapes);
        let footprints = pairs.map(|((handle, entry), shapes)| Held {
            handle: *handle,
            footprints: Footprints::of(&entry.footprints(), shapes, &self.body),
        });
        (footprints.collect(), self.body)
    }
}
