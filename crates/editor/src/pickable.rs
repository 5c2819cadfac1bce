//! The triangles that rays meet.

use std::sync::Arc;

use pliant_mesh::Bvh;

use crate::revision::Revision;

/// The data that answer rays.
#[derive(Clone)]
pub struct Pickable {
    /// The hierarchy over the shown triangles, in their shape.
    pub(crate) bvh: Bvh,
    /// Its triangles of the surface.
    pub(crate) shown: ShownTriangles,
}

/// Triangles of the surface that rays may meet.
#[derive(Clone, Default)]
pub(crate) struct ShownTriangles {
    /// A different number for every other set of triangles.
    pub(crate) revision: Revision,
    /// Their numbers, ascending; `None` is all of them.
    pub(crate) triangles: Option<Arc<Vec<u32>>>,
}
