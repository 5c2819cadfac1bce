//! The end of a drag's own descent.

use super::shape::Shape;

/// The end of a drag's own descent, while a second one is tried.
#[derive(Debug)]
pub(crate) struct First {
    pub(super) shape: Shape,
    pub has_converged: bool,
    pub has_stalled: bool,
}
