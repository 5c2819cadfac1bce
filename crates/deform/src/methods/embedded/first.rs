//! The end of a drag's own descent.

use super::energy::NodeMap;

/// The end of a drag's own descent, while a second one is tried.
#[derive(Debug)]
pub(crate) struct First {
    pub maps: Vec<NodeMap>,
    pub value: f64,
    pub has_converged: bool,
    pub has_stalled: bool,
}
