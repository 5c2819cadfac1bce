//! A mirror image that is being looked for: of what, and what is done with it.

use pliant_mesh::MirrorPlane;

use crate::document::{HandleId, Paint, Version};

/// What an image is wanted for.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Purpose {
    /// To be taken into the region that it is the image of.
    Region(Paint),
    /// To become a twin of the handle.
    Twin(HandleId),
}

/// An image that is being looked for.
#[derive(Debug)]
pub(crate) struct Mirroring {
    pub(super) purpose: Purpose,
    pub(super) plane: MirrorPlane,
    /// The paint that it was asked of.
    pub(super) paint: Version,
}
