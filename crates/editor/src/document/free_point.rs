//! A point of a curve that is held in the picture alone: free along the direction of sight.
//!
//! Such a point stays under the pointer while its distance from the eye follows from the shape. It is held again where the
//! shape has settled, so it is free from a drag to the end of the solve after it.

use glam::DVec3;

/// The free point of a curve.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct FreePoint {
    /// The control point's number.
    pub(crate) point: u32,
    /// Its way along the line on which it is free, for each unit of length in world space.
    pub(crate) along: DVec3,
    /// True if the other points follow it as a chain.
    pub(crate) is_chain: bool,
}
