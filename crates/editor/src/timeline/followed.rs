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
    /// The numbers of those whose vertices' positions are wanted, too.
    pub shaped: Vec<usize>,
    /// The paint that makes these handles.
    pub(crate) paint: Version,
}

/// The body in one frame.
#[derive(Clone, PartialEq, Debug)]
pub struct FollowedFrame {
    /// The middle of its surface vertices, in world space.
    pub middle: DVec3,
    /// The places of the followed handles, in their order.
    pub places: Vec<HandlePlace>,
    /// The positions of the vertices of the handles for which these are wanted.
    pub shapes: Vec<Vec<DVec3>>,
}
