//! Filters of handles' ways through a sequence, and the handles to follow for them and for footprints.

use std::collections::BTreeMap;

use glam::DVec3;
use pliant_mesh::SurfaceVertex;

use super::state::Workspace;
use crate::document::{Aspect, HandleFilter, HandleId, KeyFrame, Paint};
use crate::timeline::Following;

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
        Following {
            handles: handles.into_iter().collect(),
            paint: document.versions().of(Aspect::Paint),
        }
    }

    /// Returns true if filters or footprints wait for their handles to be followed.
    pub(super) fn awaits_handles(&self) -> bool {
        let (animation, frames) = (self.document.animation(), &self.frames);
        let paint = self.document.versions().of(Aspect::Paint);
        let follows_none = animation.filters().is_empty() && animation.footprints().is_empty();
        let knows_handles = follows_none || frames.ways.know(paint);
        // Footprints rest on the bent path.
        let knows_way = animation.footprints().is_empty() || !frames.way.is_unknown();
        !(frames.has_failed || (knows_handles && knows_way))
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

    /// Computes the shifts of filtered handles by the document's present filters, its footprints, and the motions of its
    /// body.
    pub(super) fn follow_filters(&mut self) {
        let document = &self.document;
        let (animation, handles) = (document.animation(), document.handles());
        let paint = document.versions().of(Aspect::Paint);
        let frames = &mut self.frames;
        frames.filters.follow(&frames.ways, paint, animation.filters(), handles);
        frames.footprints.follow(&frames.ways, paint, animation.footprints());
        self.follow_path();
    }
}
