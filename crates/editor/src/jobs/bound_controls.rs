//! The control points of the present binding: the cage or lattice in force, and the visible positions of its points.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Attachment, Bound};

/// A cage or a lattice.
#[derive(Clone, Debug)]
pub(crate) struct BoundControls {
    /// Its declared name.
    pub(crate) name: &'static str,
    /// The brought one, or the one that the method has made.
    pub(crate) attachment: Attachment,
    /// The lines between its points.
    pub(crate) edges: Arc<Vec<[u32; 2]>>,
    /// The positions of its points, in world units, moved by handles and by hand.
    pub(crate) positions: Arc<Vec<DVec3>>,
}

impl BoundControls {
    /// The control points of a binding; `None` for a method without them.
    pub(super) fn of(bound: &Bound) -> Option<Self> {
        let (name, attachment) = bound.attachment()?;
        Some(Self {
            name,
            edges: Arc::new(attachment.edges()),
            attachment: attachment.clone(),
            positions: Arc::new(bound.control_positions()),
        })
    }
}
