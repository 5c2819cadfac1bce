//! The factorisation for the present regions, and the parts of it that the window shows.

use std::sync::{Arc, Mutex};

use pliant_deform::{Bound, ReusableFactor};

use super::bound_controls::BoundControls;
use super::inspected::Inspectable;
use crate::document::HandleId;
use crate::lines::Lines;
use crate::warning::HandleWarning;

/// The factorisation for the present regions.
pub struct PresentBinding {
    pub(super) bound: Arc<Mutex<Bound>>,
    /// Its control points.
    pub(super) controls: Option<BoundControls>,
    /// The parts of it that can be shown.
    pub(super) inspectable: Inspectable,
    /// The parts that the next binding can reuse.
    pub(super) reusable_factor: Option<ReusableFactor>,
    /// The lines that its handles follow.
    pub(super) lines: Lines,
    /// Warnings about it.
    pub(super) warnings: Vec<HandleWarning>,
}

impl PresentBinding {
    /// A binding of these handles.
    pub(super) fn of(bound: Bound, handles: &[HandleId], lines: Lines) -> Self {
        Self {
            lines,
            controls: BoundControls::of(&bound),
            inspectable: Inspectable::of(&bound),
            reusable_factor: bound.reusable_factor(),
            warnings: HandleWarning::list(bound.warnings(), handles),
            bound: Arc::new(Mutex::new(bound)),
        }
    }
}
