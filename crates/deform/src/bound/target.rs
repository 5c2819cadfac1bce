//! The target of a handle.

use glam::{DAffine3, DVec3};

/// A handle's target, from rest.
#[derive(Clone, PartialEq, Debug)]
pub enum Target {
    /// An affine map of world positions.
    Map(DAffine3),
    /// A world position for each of the handle's vertices, in the order of [`crate::Bound::handle_vertices`].
    Places(Vec<DVec3>),
    /// An affine map of world positions for each of the handle's vertices, in the same order: a vertex goes to its
    /// image, and its surroundings turn as the map does. A method that takes turns needs
    /// [`crate::Constraints::sections`] to see more than one of them.
    Maps(Vec<DAffine3>),
}
