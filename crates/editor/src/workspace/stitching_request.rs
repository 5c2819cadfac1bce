//! The change of the mesh that is under way.

use crate::document::Versions;
use crate::stitching::MeshChange;

/// A change of the mesh that was asked for and has not ended.
#[derive(Clone, Debug)]
pub(crate) struct Stitching {
    pub(crate) change: MeshChange,
    /// The history's revision and the document's versions when the caller took it.
    pub(super) taken_at: Option<(u64, Versions)>,
}
