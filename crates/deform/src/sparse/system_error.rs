//! Reasons why a system could not be factored or solved, and their translation for the caller of a binding.

use pliant_mesh::{SurfaceVertex, Topology};

use crate::BindError;
use crate::budget::Limit;
use crate::sparse::factor_error::FactorError;

/// The surface vertex at which the system could not be factored or solved.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum SystemError {
    NotPositiveDefinite { vertex: u32 },
    Inaccurate { vertex: u32, error: f64 },
    OutOfMemory,
    Budget(Limit),
    Cancelled,
}

impl SystemError {
    /// A factorisation's refusal. `vertex_of` is the surface vertex of a column.
    pub fn of(error: FactorError, vertex_of: impl FnOnce(usize) -> u32) -> Self {
        match error {
            FactorError::Memory => Self::OutOfMemory,
            FactorError::Budget(limit) => Self::Budget(limit),
            FactorError::Cancelled => Self::Cancelled,
            FactorError::Pivot(column) => Self::NotPositiveDefinite {
                vertex: vertex_of(column),
            },
        }
    }

    /// The same for a matrix that is positive definite by construction, whose pivots fail for its size alone.
    pub fn of_definite(error: FactorError) -> Self {
        match error {
            FactorError::Pivot(_) => Self::OutOfMemory,
            other => Self::of(other, |_| 0),
        }
    }

    /// The error in the caller's terms.
    pub fn into_bind_error(self, topology: &Topology, free_count: usize) -> BindError {
        let component_of = |vertex: u32| topology.component(SurfaceVertex(vertex));
        match self {
            Self::NotPositiveDefinite { vertex } => BindError::NotPositiveDefinite {
                component: component_of(vertex),
                vertex,
            },
            Self::Inaccurate { vertex, error } => BindError::Inaccurate {
                component: component_of(vertex),
                vertex,
                error,
            },
            Self::OutOfMemory => BindError::OutOfMemory { free_count },
            Self::Budget(limit) => BindError::budget(free_count, limit),
            Self::Cancelled => BindError::Cancelled(pliant_mesh::Cancelled),
        }
    }

    /// Returns true if memory was too small.
    pub fn is_for_memory(self) -> bool {
        matches!(self, Self::Budget(Limit::Bytes(_)) | Self::OutOfMemory)
    }
}
