//! The domain of a method, the constraints that it supports, and the way in which it finds its shape.

/// The domain of a method.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Needs {
    /// Points in space, connected or not. The method moves every free vertex.
    Points,
    /// A surface's triangles. The method moves the vertices that a handle can reach.
    Surface {
        /// The number of edges over which a handle's influence spreads at a time, across constrained vertices too; at
        /// least 1.
        reach: u32,
        /// The power of the Laplacian whose graph gives its system's order of elimination; `None` if it needs no
        /// [`crate::Ordering`].
        ordering_power: Option<u32>,
    },
}

impl Needs {
    /// The power of the ordering that it needs, if it needs one.
    pub fn ordering_power(self) -> Option<u32> {
        match self {
            Self::Points => None,
            Self::Surface { ordering_power, .. } => ordering_power,
        }
    }
}

/// A constraint that not every method supports.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ConstraintKind {
    /// Handles that only pull at their vertices.
    SoftHandles,
    /// The smoothness with which the free surface joins constrained vertices.
    Continuity,
    /// Painted stiffness.
    Stiffness,
}

/// The way in which a bound method finds its shape.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Solve {
    /// In one step.
    Direct,
    /// Step by step, each from the last one's shape.
    Iterative {
        /// The most steps towards one set of targets; at least 1.
        max_iterations: u32,
    },
}

/// The way in which hard handles hold their vertices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum HandleFit {
    /// Exactly at the targets of the handle's transform.
    Exact,
    /// As near to the targets as the method can.
    LeastSquares,
}
