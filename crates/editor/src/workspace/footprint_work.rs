//! The places at which footprints hold handles of a sequence in every frame, once the handles were followed.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use crate::document::{BodyPath, HandleFootprints, HandleId, Version};
use crate::timeline::{BodyMotion, FollowedFrame, Following, Footprints};

/// The handles with footprints followed through all frames, and the places at which they are held.
#[derive(Debug, Default)]
pub(crate) struct FootprintWork {
    /// The positions of each handle's vertices in every frame, and the paint that makes them.
    shapes: Option<(Version, Shapes)>,
    found: BTreeMap<HandleId, Footprints>,
    /// The paint, the footprints and the path for which they were found.
    of: Option<Source>,
}

/// The positions of the vertices of handles, frame by frame.
type Shapes = BTreeMap<HandleId, Vec<Vec<DVec3>>>;

/// The source of places: the paint, the footprints, and the path that carries the body afterwards.
pub(super) type Source = (
    Version,
    Arc<BTreeMap<HandleId, HandleFootprints>>,
    Option<Arc<BodyPath>>,
);

impl FootprintWork {
    /// Returns true if the shapes of all of these handles are known, as this paint makes them.
    pub(super) fn knows(&self, paint: Version, all: &BTreeMap<HandleId, HandleFootprints>) -> bool {
        let shapes = self.shapes.as_ref().filter(|(of, _)| *of == paint);
        all.is_empty() || shapes.is_some_and(|(_, shapes)| all.keys().all(|id| shapes.contains_key(id)))
    }

    /// Takes the shapes of handles in all frames. Handles without vertices have none.
    pub(super) fn take(
        &mut self,
        following: &Following,
        frames: &[FollowedFrame],
        all: &BTreeMap<HandleId, HandleFootprints>,
    ) {
        let mut shapes: Shapes = all.keys().map(|id| (*id, Vec::new())).collect();
        for (place, number) in following.shaped.iter().enumerate() {
            let own = frames.iter().filter_map(|frame| frame.shapes.get(place).cloned());
            shapes.insert(following.handles[*number].0, own.collect());
        }
        self.shapes = Some((following.paint, shapes));
        self.of = None;
    }

    /// The places at which a handle is held in a frame.
    pub(super) fn held(&self, handle: HandleId, frame: usize) -> Option<Arc<Vec<DVec3>>> {
        let places = self.found.get(&handle)?.places.get(&frame)?;
        Some(Arc::new(places.clone()))
    }

    /// The number of footprints of a handle.
    pub(super) fn count(&self, handle: HandleId) -> Option<usize> {
        Some(self.found.get(&handle)?.count)
    }

    /// Finds the places for these footprints on this path, along which the body has these motions.
    pub(super) fn follow(&mut self, source: Source, body: &[BodyMotion]) {
        if self.of.as_ref() == Some(&source) {
            return;
        }
        self.found.clear();
        if let Some((_, shapes)) = self.shapes.as_ref().filter(|(of, _)| *of == source.0) {
            let known = source.1.iter().filter_map(|(id, entry)| {
                let shapes = shapes.get(id).filter(|shapes| !shapes.is_empty())?;
                Some((*id, Footprints::of(entry, shapes, body)))
            });
            self.found = known.collect();
            self.of = Some(source);
        }
    }
}
