//! The demands of a method on the partition of the surface.

use crate::{ConstraintKind, Needs};

/// The facts about a method that decide which vertices it solves for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Demands {
    pub method: &'static str,
    pub needs: Needs,
    /// The constraints that it supports.
    pub heeds: &'static [ConstraintKind],
    /// True if examples bend the surface by themselves.
    pub examples_bend: bool,
}
