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
    Maps(Vec<TurnedMap>),
}

/// An affine map of world positions, and the turn of the way on which it was reached.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct TurnedMap {
    /// The map, from rest.
    pub map: DAffine3,
    /// Axis times angle of the way from rest, in radians. Only its full turns count, which the map does not show.
    pub turn_rad: DVec3,
}

impl TurnedMap {
    /// Returns true if all numbers are finite.
    pub(super) fn is_finite(&self) -> bool {
        self.map.is_finite() && self.turn_rad.is_finite()
    }
}
