//! The shifts of the handles of a sequence whose ways are filtered, once the handles were followed.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::handle_ways::HandleWays;
use crate::document::{Handle, HandleFilter, HandleId, Version};
use crate::timeline::{HandlePlace, filter_shifts};

/// The shifts of handles by their filters.
#[derive(Debug, Default)]
pub(crate) struct FilterWork {
    /// By frame.
    shifts: BTreeMap<HandleId, BTreeMap<usize, DVec3>>,
    /// The paint, the filters and the parents for which they were computed.
    of: Option<Source>,
}

/// The source of shifts: the paint, the filters, and each filtered handle's parent.
type Source = (Version, Arc<BTreeMap<HandleId, HandleFilter>>, Vec<Option<HandleId>>);

impl FilterWork {
    /// The shift of a handle in a frame.
    pub(super) fn shift(&self, handle: HandleId, frame: usize) -> DVec3 {
        let shifts = self.shifts.get(&handle);
        shifts
            .and_then(|shifts| shifts.get(&frame))
            .copied()
            .unwrap_or_default()
    }

    /// Computes the shifts for these filters and handles, if the ways are those of this paint.
    pub(super) fn follow(
        &mut self,
        ways: &HandleWays,
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
        if !ways.know(paint) {
            return;
        }
        for ((id, filter), parent) in filters.iter().zip(&source.2) {
            let [first, last] = filter.span;
            let place = |handle: HandleId, frame: usize| Some(ways.of(handle)?.get(frame)?.place);
            let at = |frame: usize| {
                let parent = parent.and_then(|parent| place(parent, frame));
                Some((place(*id, frame)?, parent))
            };
            let own: Option<Vec<(HandlePlace, Option<HandlePlace>)>> = (first..=last).map(at).collect();
            let gain = filter.kind.gain(filter.amount);
            if let Some(own) = own {
                let shifts = filter_shifts(&own, filter.width, gain);
                self.shifts.insert(*id, (first..).zip(shifts).collect());
            }
        }
        self.of = Some(source);
    }
}
