//! What a solve from a kept shape goes on from.

use std::sync::Arc;

use glam::DVec3;

use crate::document::KeptShape;

/// What a solve from a kept shape goes on from.
#[derive(Clone, Debug)]
pub(crate) struct Carried {
    /// The shape that was kept.
    pub(crate) kept: Arc<KeptShape>,
    /// The solution for the transforms at which it was kept.
    pub(crate) at_first: Arc<Vec<DVec3>>,
    /// The solution for the present transforms, without what is carried along.
    pub(crate) solution: Arc<Vec<DVec3>>,
    /// What is shown of it.
    pub(crate) shown: Arc<Vec<DVec3>>,
    /// What of that was corrected by hand.
    pub(crate) corrections: Option<Arc<Vec<DVec3>>>,
}
