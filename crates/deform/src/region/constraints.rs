//! The strength of the handles' pull, and the smoothness with which the free surface joins constrained vertices.

use std::ops::RangeInclusive;

use crate::{BindError, Loose};

/// The properties of constrained vertices beyond their roles. The default is hard handles, joined as smoothly as the
/// method can.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Constraints<'a> {
    /// For each handle: `None` if its vertices move exactly with it; for a *soft* one its weight, a positive number
    /// without unit. Empty if all are hard.
    ///
    /// A soft handle pulls at each of its vertices i by a spring of strength
    ///
    /// W_i = w M_ii (k_s q + k_b qⁿ), q = π² / Σ M_ii,
    ///
    /// where n is the bi-Laplacian's order and the sum goes over the handle. That is w times the resistance of the
    /// bi-Laplacian to a half wave as long as the handle's width, so that at 1 neither dominates. It depends neither on
    /// the mesh's resolution nor on its unit. A larger w is closer to a hard handle.
    pub soft: &'a [Option<f64>],
    /// For each surface vertex that is constrained: the continuity Cᵏ with which the free surface joins it, from 0 to 2
    /// \[BK04\] and at most Cⁿ⁻¹, n the bi-Laplacian's order. 0 is a hinge, 1 keeps the tangents, 2 the curvature; a
    /// number between is a hinge with a spring, equally stiff at every resolution. Empty if it is 2 everywhere.
    pub continuity: &'a [f64],
    /// The behaviour of single components that nothing holds, by their number in the topology, instead of
    /// [`crate::Problem::loose`]. The last entry for a component counts.
    pub parts: &'a [(u32, Loose)],
    /// For each surface vertex of a handle: the section of its handle. Vertices of one section turn alike, and a handle
    /// of several sections has several turns, which [`crate::Target::Maps`] gives. Empty if every handle is one section.
    pub sections: &'a [u16],
}

/// The range of a continuity.
pub const CONTINUITY_RANGE: RangeInclusive<f64> = 0.0..=2.0;

impl Constraints<'_> {
    /// The weight of a handle, if it is soft.
    pub(crate) fn weight(&self, handle: u16) -> Option<f64> {
        self.soft.get(usize::from(handle)).copied().flatten()
    }

    /// Checks that every table fits the problem and that every number is in its range.
    pub(crate) fn check(&self, vertex_count: usize, handle_count: usize) -> Result<(), BindError> {
        for (table, found, expected) in [
            ("the table of handles' weights", self.soft.len(), handle_count),
            ("the continuity table", self.continuity.len(), vertex_count),
            ("the table of sections", self.sections.len(), vertex_count),
        ] {
            if found != 0 && found != expected {
                return Err(BindError::Length { table, found, expected });
            }
        }
        for (handle, &value) in self.soft.iter().enumerate() {
            if let Some(value) = value
                && !(value.is_finite() && value > 0.0)
            {
                return Err(BindError::SoftWeight { handle, value });
            }
        }
        match self
            .continuity
            .iter()
            .position(|value| !CONTINUITY_RANGE.contains(value))
        {
            Some(vertex) => Err(BindError::Continuity {
                vertex: vertex as u32,
                value: self.continuity[vertex],
            }),
            None => Ok(()),
        }
    }
}
