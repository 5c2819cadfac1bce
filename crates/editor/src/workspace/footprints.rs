//! Footprints of handles of a sequence, which are held wherever they rest on the ground.

use std::sync::Arc;

use super::state::Workspace;
use crate::document::{HandleFootprints, HandleId, Version};

/// Holds a handle wherever it rests on the ground, or no longer.
pub(crate) fn set_footprints(workspace: &mut Workspace, handle: HandleId, footprints: Option<HandleFootprints>) {
    workspace.step("Footprints", |workspace| {
        let animation = workspace.document.animation().with_footprints(handle, footprints);
        workspace.document.set_animation(animation);
        workspace.try_to_follow_again();
        workspace.pose_frame();
    });
}

impl Workspace {
    /// The number of footprints of a handle; `None` until the frames were followed.
    pub(crate) fn footprints_of(&self, handle: HandleId) -> Option<usize> {
        self.frames.footprints.count(handle)
    }

    /// Finds the places of footprints by the document's present ones and its path.
    pub(super) fn follow_footprints(&mut self, paint: Version) {
        self.follow_path();
        let animation = self.document.animation();
        let source = (paint, Arc::clone(animation.footprints()), animation.path().cloned());
        self.frames.footprints.follow(source, self.frames.way.motions());
    }
}
