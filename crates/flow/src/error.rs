//! Why a flow stops, in one sentence each.

use pliant_deform::{BindError, SolveError};
use pliant_mesh::Cancelled;

/// A flow could not be prepared or continued. Vertices are the surface's.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FlowError {
    /// The flag was raised.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The surface has no triangle.
    #[error("there is no triangle, and a flow needs a surface: take a file with triangles")]
    NoTriangles,
    /// The Laplacian's factor would take more memory than allowed.
    #[error("the pressure of {vertices} vertices takes more memory than allowed: make the mesh coarser, or allow more")]
    Memory {
        /// The number of the surface's vertices.
        vertices: usize,
    },
    /// A strip of triangles that is too long for the Laplacian's numbers.
    #[error(
        "vertex {vertex} is {edges} edges from the end of its strip, too far to find its pressure: make the mesh coarser"
    )]
    Slender {
        /// The farthest vertex.
        vertex: u32,
        /// The number of edges.
        edges: usize,
    },
    /// The Laplacian can't be factored there.
    #[error("the pressure at vertex {vertex} can't be found: repair the triangles around it")]
    Pressure {
        /// The vertex.
        vertex: u32,
    },
    /// A step's pressure stayed too inaccurate.
    #[error("the pressure is found only to {error:.1e}: repair the mesh's thinnest triangles")]
    Inaccurate {
        /// The error relative to the largest value.
        error: f64,
    },
    /// A velocity is not a finite number any longer.
    #[error("the velocity grows past all numbers: lower the velocities, the gravity or the confinement")]
    NotFinite,
}

impl FlowError {
    /// The reason for which the Laplacian of a surface with this many vertices could not be factored.
    pub(crate) fn of_binding(error: BindError, vertices: usize) -> Self {
        match error {
            BindError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            BindError::Budget { .. } | BindError::OutOfMemory { .. } => Self::Memory { vertices },
            BindError::Slender { vertex, edges, .. } => Self::Slender { vertex, edges },
            other => Self::Pressure {
                vertex: other.vertex().unwrap_or(0),
            },
        }
    }

    /// The reason for which a step's pressure could not be found.
    pub(crate) fn of_solve(error: &SolveError) -> Self {
        match error {
            SolveError::Inaccurate { error } => Self::Inaccurate { error: *error },
            _ => Self::NotFinite,
        }
    }

    /// The error with another numbering's vertex instead of the surface's.
    #[must_use]
    pub fn renumbered(mut self, known: impl Fn(u32) -> u32) -> Self {
        if let Self::Slender { vertex, .. } | Self::Pressure { vertex } = &mut self {
            *vertex = known(*vertex);
        }
        self
    }
}
