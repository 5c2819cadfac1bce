//! The handles of a sequence followed through all frames, and the shifts of those whose ways are filtered.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use crate::document::{Handle, HandleFilter, HandleId, Version};
use crate::timeline::{FollowedFrame, Following, HandlePlace, filter_shifts};

/// The handles followed through all frames, and the shifts of those with filters.
#[derive(Debug, Default)]
pub(crate) struct FilterWork {
    /// The places of handles in each frame, and the paint that makes them.
    places: Option<(Version, Vec<BTreeMap<HandleId, HandlePlace>>)>,
    /// The shifts by the filters, by frame.
    shifts: BTreeMap<HandleId, BTreeMap<usize, DVec3>>,
    /// The paint, the filters and the parents for which they were computed.
    of: Option<Source>,
}

/// The source of shifts: the paint, the filters, and each filtered handle's parent.
type Source = (Version, Arc<BTreeMap<HandleId, HandleFilter>>, Vec<Option<HandleId>>);

impl FilterWork {
    /// Returns true if the places of the handles that this paint makes are known.
    pub(super) fn knows(&self, paint: Version) -> bool {
        self.places.as_ref().is_some_and(|(of, _)| *of == paint)
    }

    /// Takes the places of handles in all frames.
    pub(super) fn take(&mut self, following: &Following, frames: &[FollowedFrame]) {
        let of_frame = |frame: &FollowedFrame| {
            let ids = following.handles.iter().map(|(id, _)| *id);
            ids.zip(frame.places.iter().copied()).collect()
        };
        self.places = Some((following.paint, frames.iter().map(of_frame).collect()));
        self.of = None;
    }

    /// The shift of a handle in a frame.
    pub(super) fn shift(&self, handle: HandleId, frame: usize) -> DVec3 {
        let shifts = self.shifts.get(&handle);
        shifts
            .and_then(|shifts| shifts.get(&frame))
            .copied()
            .unwrap_or_default()
    }

    /// Computes the shifts for these filters and handles.
    pub(super) fn follow(
        &mut self,
        paint: Version,
        filters: &Arc<BTreeMap<HandleId, HandleFilter>>,
        handles: &[Handle],
    ) {
        let parent_of = |id: &HandleId| handles.iter().find(|handle| handle.id == *id)?.parent;
        let parents: Vec<Option<HandleId>> = filters.keys().map(parent_of).collect();
        let source = (paint, Arc::clone(filters), parents);
        if self.of.as_ref() == Some(&source) {
            return;
        }
        self.shifts.clear();
        if let Some((_, places)) = self.places.as_ref().filter(|(of, _)| *of == paint) {
            for ((id, filter), parent) in filters.iter().zip(&source.2) {
                let [first, last] = filter.span;
                let frames = places.get(first..=last).unwrap_or_default();
                let place = |frame: &BTreeMap<HandleId, HandlePlace>| {
                    let parent = parent.and_then(|parent| frame.get(&parent).copied());
                    Some((*frame.get(id)?, parent))
                };
                let own: Option<Vec<(HandlePlace, Option<HandlePlace>)>> = frames.iter().map(place).collect();
                let gain = filter.kind.gain(filter.amount);
                if let Some(own) = own {
                    let shifts = filter_shifts(&own, filter.width, gain);
                    self.shifts.insert(*id, (first..).zip(shifts).collect());
                }
            }
            self.of = Some(source);
        }
    }
}
