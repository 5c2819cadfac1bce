//! Handles followed through the frames of a sequence: their places, and the shapes of those with footprints.

use std::collections::BTreeMap;

use glam::DVec3;
use pliant_editor::{EditError, EditFile, FootprintEntry, HandlePlace, SequenceTimeline, Setup};
use pliant_mesh::{Drawn, SurfaceVertex};
use rayon::prelude::*;

use super::bend::place;
use super::footprints::Footprints;
use super::frame::Frame;
use super::run::Source;
use crate::EngineError;
use crate::loading::Loaded;
use crate::watch::Watch;

/// The handles in the frames that an edit needs.
pub(super) struct Followed {
    /// The place of each handle at rest, in the file whose vertices all frames have.
    rest: Vec<HandlePlace>,
    frames: BTreeMap<usize, OfFrame>,
}

struct OfFrame {
    /// The place of each handle.
    places: Vec<HandlePlace>,
    /// The positions of the vertices of each handle with footprints, in their order.
    shapes: Vec<Vec<DVec3>>,
}

impl Followed {
    /// Reads the frames `needed`.
    ///
    /// # Errors
    /// A frame that can't be read; [`EngineError::Interrupted`].
    pub fn of(
        needed: &[usize],
        (first, drawn, source): (&Loaded, &Drawn, &Source),
        (handles, footprints): (&[Vec<SurfaceVertex>], &[(usize, &FootprintEntry)]),
        watch: &Watch,
    ) -> Result<Self, EngineError> {
        let progress = watch.begin("following the handles");
        let rest = &first.model.surface.positions;
        let places = |positions: &[DVec3]| -> Vec<HandlePlace> {
            handles
                .iter()
                .map(|vertices| place(vertices, rest, positions))
                .collect()
        };
        let of_frame = |frame: usize| -> Result<(usize, OfFrame), EngineError> {
            watch.cancel.check().map_err(|_| EngineError::Interrupted)?;
            let positions = match source {
                Source::Folder(frames) => Frame::read(&frames[frame], first, drawn, watch)?.positions,
                Source::Cache(cache) => cache.frame(frame)?.positions,
            };
            let shape = |(handle, _): &(usize, &FootprintEntry)| -> Vec<DVec3> {
                handles[*handle]
                    .iter()
                    .map(|vertex| positions[vertex.index()])
                    .collect()
            };
            let of_frame = OfFrame {
                places: places(&positions),
                shapes: footprints.iter().map(shape).collect(),
            };
            Ok((frame, of_frame))
        };
        let mut frames = BTreeMap::new();
        for group in needed.chunks(rayon::current_num_threads().max(1)) {
            let read: Vec<_> = group.par_iter().map(|frame| of_frame(*frame)).collect();
            for read in read {
                frames.extend([read?]);
            }
            progress.set(frames.len() as f32 / needed.len() as f32);
        }
        Ok(Self {
            rest: places(rest),
            frames,
        })
    }

    /// The handles' motions by keys and filters.
    ///
    /// # Errors
    /// Those of [`EditFile::sequence_timeline`].
    pub fn timeline(&self, edit: &EditFile, setup: &Setup) -> Result<SequenceTimeline, EditError> {
        edit.sequence_timeline(setup, &self.rest, |frame, handle| self.frames[&frame].places[handle])
    }

    /// The footprints. All frames were read if there are some.
    pub fn footprints(self, entries: &[(usize, &FootprintEntry)]) -> Vec<Footprints> {
        let mut shapes: Vec<Vec<Vec<DVec3>>> = vec![Vec::new(); entries.len()];
        for of_frame in self.frames.into_values() {
            for (shapes, shape) in shapes.iter_mut().zip(of_frame.shapes) {
                shapes.push(shape);
            }
        }
        let pairs = entries.iter().zip(&shapes);
        pairs
            .map(|((handle, entry), shapes)| Footprints::of(*handle, entry, shapes))
            .collect()
    }
}
