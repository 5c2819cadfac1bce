//! Whether a shape is known to be finite.

/// Sets whether a shape was found to be finite during its computation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Finite {
    Yes,
    Unknown,
}
