//! A temporary pose, in which hidden places can be reached: legs are spread, the inside is painted and corrected, and
//! everything then returns to its place to the bit.
//!
//! Paint and stiffness belong to vertices, so they stay when the pose is left. A correction is a displacement in the
//! posed surface: it turns back with the surface around its vertex.

use std::sync::Arc;

use glam::DVec3;

use super::content::Content;
use super::version::Versions;

/// The state to which a document returns from its work pose.
#[derive(Clone, Debug)]
pub(crate) struct WorkPose {
    /// The document at the beginning, without a work pose.
    pub(crate) before: Content,
    /// Its versions.
    pub(crate) versions: Versions,
    /// The corrections made since then, per surface vertex, as displacements of the shape at the beginning; `None`
    /// without any.
    pub(crate) corrected: Option<Arc<Vec<DVec3>>>,
}
