//! The choice of vertices that count as one.

/// The choice of vertices that count as one.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct WeldOptions {
    /// Vertices closer than this are joined, in world units, 0 (only equal ones) or more; near triangles less than
    /// twice as long, half their length. `None` derives the distance from the mesh: see [`Model::weld`](crate::Model::weld).
    pub distance: Option<f64>,
}
