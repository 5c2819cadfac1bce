//! Sizes of the meshes.

/// Sizes of the meshes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Scale {
    /// Up to 200 thousand vertices.
    Usual,
    /// Up to a million and more.
    Full,
}
