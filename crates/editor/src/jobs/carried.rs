//! The state from which a solve with a kept shape continues.

use std::sync::Arc;

use glam::DVec3;

use crate::document::KeptShape;

/// The state from which a solve with a kept shape continues.
#[derive(Clone, Debug)]
pub(crate) struct Carried {
    /// The kept shape.
    pub(crate) kept: Arc<KeptShape>,
    /// The solution for the transforms of the kept shape.
    pub(crate) at_first: Arc<Vec<DVec3>>,
    /// The solution for the present transforms, without the residual.
    pub(crate) solution: Arc<Vec<DVec3>>,
    /// The shown shape.
    pub(crate) shown: Arc<Vec<DVec3>>,
    /// The part of it that was corrected by hand.
    pub(crate) corrections: Option<Arc<Vec<DVec3>>>,
}
