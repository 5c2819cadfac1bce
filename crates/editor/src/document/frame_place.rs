//! The place of a handle in a frame of a sequence.

use glam::DVec3;

use super::handle_transform::HandleTransform;

/// The pivot of a handle on a frame's shape, and its transform there.
pub(crate) type FramePlace = (DVec3, HandleTransform);
