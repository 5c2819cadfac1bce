//! The handles of a sequence followed through all frames.

use std::collections::BTreeMap;

use crate::document::{HandleId, Version};
use crate::timeline::{FollowedFrame, FollowedHandle, Following};

/// The handles in every frame, and the paint that makes them.
#[derive(Debug, Default)]
pub(crate) struct HandleWays {
    handles: BTreeMap<HandleId, Vec<FollowedHandle>>,
    of: Option<Version>,
}

impl HandleWays {
    /// Returns true if the handles that this paint makes were followed.
    pub(super) fn know(&self, paint: Version) -> bool {
        self.of == Some(paint)
    }

    /// Takes the handles in all frames.
    pub(super) fn take(&mut self, following: &Following, frames: &[FollowedFrame]) {
        let followed = following.handles.iter().enumerate();
        let way = |number: usize| {
            frames
                .iter()
                .filter_map(|frame| frame.handles.get(number).copied())
                .collect()
        };
        self.handles = followed.map(|(number, (id, _))| (*id, way(number))).collect();
        self.of = Some(following.paint);
    }

    /// A handle in every frame; `None` if the frames were not followed, or if the handle has no vertices.
    pub(super) fn of(&self, handle: HandleId) -> Option<&[FollowedHandle]> {
        self.handles.get(&handle).map(Vec::as_slice)
    }
}
