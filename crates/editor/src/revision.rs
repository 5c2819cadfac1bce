//! The number of a state.

/// The number of the state for which a job was made. Numbers only grow; none is used twice.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub struct Revision(pub u64);
