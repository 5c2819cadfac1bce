//! The parts of a binding that a person can show, and their values.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::Bound;

use crate::document::HandleId;

/// The parts of a binding that can be shown.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Inspectable {
    /// Whether the method spreads the handles' effect by weights.
    pub weights: bool,
    /// Whether it bends a smooth base and puts the details back.
    pub base: bool,
}

/// The shown parts of a binding.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) struct Asked {
    /// The handle whose weights are shown.
    pub(crate) weights_of: Option<HandleId>,
    /// Whether the smooth base is shown.
    pub(crate) base: bool,
}

/// The values from a binding.
#[derive(Clone, Debug, Default)]
pub struct Inspected {
    /// The handle's weight at each surface vertex, from 0 to 1.
    pub(crate) weights: Option<Arc<Vec<f64>>>,
    /// The smooth base bent by the handles, as displacements of the surface's vertices from the file's shape.
    pub(crate) base: Option<Arc<Vec<DVec3>>>,
}

impl Inspectable {
    /// Queries a binding. This costs a pass over the surface.
    pub(super) fn of(bound: &Bound) -> Self {
        Self {
            weights: bound.handle_weights(0).is_some(),
            base: bound.base(&mut vec![DVec3::ZERO; bound.vertex_count()]),
        }
    }
}
