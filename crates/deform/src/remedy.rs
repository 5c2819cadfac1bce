//! Other methods that a message advises.

use crate::ConstraintKind;

/// The methods that can do something that another one can't. It is displayed as their names, joined by "or"
/// (`registry.rs`).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Remedy {
    /// The first methods that bend space and need no surface.
    OfSpace,
    /// The methods that bend space and keep no table for each handle.
    OfSpaceForManyHandles,
    /// All methods that support a constraint.
    Heeding(ConstraintKind),
    /// All methods in which each vertex of a handle can have its own target position.
    TakingPlaces,
    /// The methods that find turns from handles that only move.
    TurningByMoves,
    /// The methods that follow turns of this many degrees between handles.
    FollowingTurns(u16),
    /// What can be done about triangles and edges that this method, by its name, has damaged: less of the edit, or a
    /// method that keeps triangles from collapsing.
    OfDamageBy(&'static str),
}
