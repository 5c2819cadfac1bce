//! Filters of handles' ways through a sequence: their shifts in every frame, once the handles were followed.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::SurfaceVertex;

use super::state::Workspace;
use crate::document::{Aspect, Handle, HandleFilter, HandleId, KeyFrame, Paint, Version};
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
    fn follow(&mut self, paint: Version, filters: &Arc<BTreeMap<HandleId, HandleFilter>>, handles: &[Handle]) {
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

/// Gives a handle's way another filter, or none.
pub(crate) fn set_filter(workspace: &mut Workspace, handle: HandleId, filter: Option<HandleFilter>) {
    workspace.step("Filter", |workspace| {
        let animation = workspace.document.animation().with_filter(handle, filter);
        workspace.document.set_animation(animation);
        workspace.frames.has_failed = false;
        workspace.pose_frame();
    });
}

impl Workspace {
    /// The handles to follow through all frames; none if no way is filtered, and no handle is held by footprints.
    pub(crate) fn following(&self) -> Following {
        let document = &self.document;
        let mut handles: BTreeMap<HandleId, Vec<SurfaceVertex>> = BTreeMap::new();
        let footprints = document.animation().footprints();
        if !(document.animation().filters().is_empty() && footprints.is_empty()) {
            for (vertex, paint) in (0..).zip(document.paint()) {
                if let Paint::Handle(id) = paint {
                    handles.entry(*id).or_default().push(SurfaceVertex(vertex));
                }
            }
        }
        let shaped = handles.keys().enumerate().filter(|(_, id)| footprints.contains_key(id));
        Following {
            shaped: shaped.map(|(number, _)| number).collect(),
            handles: handles.into_iter().collect(),
            paint: document.versions().of(Aspect::Paint),
        }
    }

    /// Returns true if filters or footprints wait for their handles to be followed.
    pub(super) fn awaits_handles(&self) -> bool {
        let (animation, frames) = (self.document.animation(), &self.frames);
        let paint = self.document.versions().of(Aspect::Paint);
        let knows_places = animation.filters().is_empty() || frames.filters.knows(paint);
        let knows_all = knows_places && frames.footprints.knows(paint, animation.footprints());
        // Footprints rest on the bent path.
        let knows_way = animation.footprints().is_empty() || !frames.way.is_unknown();
        !(frames.has_failed || (knows_all && knows_way))
    }

    /// Takes the shifts by filters off a key of the shown frame, which they will move further. A handle that only its
    /// filter has moved needs no key.
    pub(super) fn without_filters(&self, key: &mut KeyFrame) {
        let animation = self.document.animation();
        let frame = animation.frame();
        let has_several = key.handles.len() > 1;
        key.handles.retain(|id, placed| {
            let shift = self.frames.filters.shift(*id, frame);
            if animation.frames().is_none() || shift == DVec3::ZERO {
                return true;
            }
            let transform = placed.stance.transform.moved_by(-shift);
            placed.stance.transform = transform;
            !has_several || !transform.is_identity() || animation.span_at(*id, frame).is_some()
        });
    }

    /// Computes the shifts of filtered handles by the document's present filters, and the places of footprints.
    pub(super) fn follow_filters(&mut self) {
        let document = &self.document;
        let paint = document.versions().of(Aspect::Paint);
        let (filters, handles) = (document.animation().filters(), document.handles());
        self.frames.filters.follow(paint, filters, handles);
        self.follow_footprints(paint);
    }
}
