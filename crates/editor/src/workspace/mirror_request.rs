//! A requested mirror image: its source, and the action on it.

use pliant_mesh::MirrorPlane;

use crate::document::{HandleId, Paint, Version};

/// The action on an image.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Purpose {
    /// Its addition to the region of which it is the image.
    Region(Paint),
    /// Its use as a twin of the handle.
    Twin(HandleId),
}

/// A requested image.
#[derive(Debug)]
pub(crate) struct Mirroring {
    pub(super) purpose: Purpose,
    pub(super) plane: MirrorPlane,
    /// The paint of the request.
    pub(super) paint: Version,
}
