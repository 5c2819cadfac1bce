//! The footprints of the handles of a sequence, once the handles were followed, and the shapes of those in the few frames
//! by which the shown one is held.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::handle_ways::HandleWays;
use crate::document::{HandleFootprints, HandleId, Version};
use crate::timeline::{BodyMotion, Footprints};

/// The footprints that were found, and the positions of handles' vertices in frames that hold others.
#[derive(Debug, Default)]
pub(crate) struct FootprintWork {
    found: BTreeMap<HandleId, Footprints>,
    /// The paint and the footprints for which they were found.
    of: Option<(Version, Arc<BTreeMap<HandleId, HandleFootprints>>)>,
    /// The handles' vertices, by frame.
    shapes: BTreeMap<usize, Shapes>,
}

/// The positions of the vertices of each handle with footprints, in world space.
pub(super) type Shapes = BTreeMap<HandleId, Vec<DVec3>>;

impl FootprintWork {
    /// Finds these footprints, if the ways are those of this paint.
    pub(super) fn follow(
        &mut self,
        ways: &HandleWays,
        paint: Version,
        footprints: &Arc<BTreeMap<HandleId, HandleFootprints>>,
    ) {
        let source = (paint, Arc::clone(footprints));
        if self.of.as_ref() == Some(&source) {
            return;
        }
        let is_of_paint = self.of.as_ref().is_some_and(|(of, _)| *of == paint);
        let has_shapes = is_of_paint && footprints.keys().all(|id| self.found.contains_key(id));
        if !has_shapes {
            self.shapes.clear();
        }
        self.found.clear();
        self.of = None;
        if ways.know(paint) {
            let found = footprints
                .iter()
                .filter_map(|(id, entry)| Some((*id, Footprints::of(entry, ways.of(*id)?))));
            self.found = found.collect();
            self.of = Some(source);
        }
    }

    /// A frame in which the shapes of handles are needed for a frame, and not known.
    pub(super) fn unknown_in(&self, frame: usize) -> Option<usize> {
        let mut needed = self.needed_in(frame);
        needed.find(|needed| !self.shapes.contains_key(needed))
    }

    /// Notes the shapes in a frame if a `wanted` one needs them, and forgets those that none of these needs.
    pub(super) fn note(&mut self, frame: usize, wanted: &[usize], shapes: impl FnOnce() -> Shapes) {
        let needed: Vec<usize> = wanted.iter().flat_map(|wanted| self.needed_in(*wanted)).collect();
        self.shapes.retain(|frame, _| needed.contains(frame));
        if needed.contains(&frame) {
            self.shapes.entry(frame).or_insert_with(shapes);
        }
    }

    /// The places at which a handle whose vertices are at `own` is held in a frame of a body with these motions.
    pub(super) fn held(
        &self,
        handle: HandleId,
        frame: usize,
        own: &Shapes,
        body: &[BodyMotion],
    ) -> Option<Arc<Vec<DVec3>>> {
        let shape_in = |frame: usize| self.shapes.get(&frame)?.get(&handle).map(Vec::as_slice);
        let places = self
            .found
            .get(&handle)?
            .places(frame, own.get(&handle)?, shape_in, body)?;
        Some(Arc::new(places))
    }

    /// Returns true if a handle is held in a frame.
    pub(super) fn hold_in(&self, frame: usize) -> bool {
        self.found.values().any(|found| found.hold(frame))
    }

    /// The number of footprints of a handle.
    pub(super) fn count(&self, handle: HandleId) -> Option<usize> {
        Some(self.found.get(&handle)?.count())
    }

    fn needed_in(&self, frame: usize) -> impl Iterator<Item = usize> {
        self.found.values().flat_map(move |found| found.needed_in(frame))
    }
}
