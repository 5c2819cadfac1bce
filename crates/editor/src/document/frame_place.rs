//! The place of a handle in a frame of a sequence.

use std::sync::Arc;

use glam::DVec3;

use super::handle_transform::HandleTransform;

/// The place of a handle in a frame of a sequence.
#[derive(Clone, Debug)]
pub(crate) struct FramePlace {
    /// Its pivot on the frame's shape.
    pub(crate) pivot: DVec3,
    /// Its transform there.
    pub(crate) transform: HandleTransform,
    /// The places at which a footprint holds its vertices.
    pub(crate) held: Option<Arc<Vec<DVec3>>>,
}
