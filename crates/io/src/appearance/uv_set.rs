//! The sets of texture coordinates that drawn vertices have.

/// The set of texture coordinates of an image.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum UvSet {
    /// [`Appearance::uvs`](crate::Appearance::uvs), those of the base colour.
    Base,
    /// [`Appearance::second_uvs`](crate::Appearance::second_uvs).
    Second,
}
