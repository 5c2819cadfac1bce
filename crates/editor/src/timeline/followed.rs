//! A body and its handles followed through the frames of a sequence.

use glam::DVec3;
use pliant_mesh::SurfaceVertex;

use super::span::HandlePlace;
use crate::document::{HandleId, Version};

/// The handles to follow through all frames of a sequence, beside the whole body.
#[derive(Clone, PartialEq, Debug)]
pub struct Following {
    /// The vertices of each, of which there is one at least.
    pub handles: Vec<(HandleId, Vec<SurfaceVertex>)>,
    /// The paint that makes these handles.
    pub(crate) paint: Version,
}

/// The body in one frame.
#[derive(Clone, PartialEq, Debug)]
pub struct FollowedFrame {
    /// The middle of its surface vertices, in world space.
    pub middle: DVec3,
    /// The followed handles, in their order.
    pub handles: Vec<FollowedHandle>,
}

/// A handle in one frame: all that filters need of it, and all by which its footprints are found. Its vertices are not
/// kept, because the frames of a long sequence need not fit into memory.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct FollowedHandle {
    /// Its place.
    pub place: HandlePlace,
    /// The lowest coordinate of its vertices along each axis, in world space.
    pub lowest: DVec3,
}

impl FollowedHandle {
    /// The handle whose vertices are at `first` in the first frame and at `now` in this one. Both have at least one entry.
    pub fn of(first: &[DVec3], now: &[DVec3]) -> Self {
        Self {
            place: HandlePlace::of(first, now),
            lowest: now.iter().fold(DVec3::INFINITY, |lowest, place| lowest.min(*place)),
        }
    }
}
