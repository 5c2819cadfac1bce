//! Reasons why a system could not be factored or solved.

use crate::BindError;
use crate::bilaplacian::operator::BilaplacianOperator;
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
    /// A factorisation's refusal, whose columns are the local vertices `columns`.
    pub(super) fn of(error: FactorError, operator: &BilaplacianOperator, columns: &[u32]) -> Self {
        match error {
            FactorError::Memory => Self::OutOfMemory,
            FactorError::Budget(limit) => Self::Budget(limit),
            FactorError::Cancelled => Self::Cancelled,
            FactorError::Pivot(column) => {
                let local = columns.get(column).map_or(0, |&local| local as usize);
                Self::NotPositiveDefinite {
                    vertex: operator.laplacian.vertices()[local],
                }
            }
        }
    }

    /// The error in the caller's terms.
    pub fn into_bind_error(self, component_of: impl Fn(u32) -> u32, free_count: usize) -> BindError {
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
