//! What a person can look at of a binding, and what was found there.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::Bound;

use crate::document::HandleId;

/// What of a binding can be looked at.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Inspectable {
    /// Whether the method spreads what handles do by weights.
    pub weights: bool,
    /// Whether it bends a smooth base and puts the details back.
    pub base: bool,
}

/// What of a binding is looked at.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) struct Asked {
    /// The handle whose weights are shown.
    pub(crate) weights_of: Option<HandleId>,
    /// Whether the smooth base is shown.
    pub(crate) base: bool,
}

/// What was found in a binding.
#[derive(Clone, Debug, Default)]
pub struct Inspected {
    /// The handle's weight at each surface vertex, from 0 to 1.
    pub(crate) weights: Option<Arc<Vec<f64>>>,
    /// The smooth base as the handles bend it, as displacements of the surface's vertices from the file's shape.
    pub(crate) base: Option<Arc<Vec<DVec3>>>,
}

impl Inspectable {
    /// Asks a binding. It costs a pass over the surface.
    pub(super) fn of(bound: &Bound) -> Self {
        Self {
            weights: bound.handle_weights(0).is_some(),
            base: bound.base(&mut vec![DVec3::ZERO; bound.vertex_count()]),
        }
    }
}
