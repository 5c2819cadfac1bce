//! The triangles and vertices that may be seen and painted, computed from the hidden and locked parts.

use std::sync::Arc;

use pliant_mesh::Model;

use super::access::Access;

/// The effect of an [`Access`] on a model; `None` if it changes nothing.
#[derive(Debug, Default)]
pub(crate) struct VertexAccess {
    /// For each drawn triangle, true if it is shown.
    pub(crate) drawn: Option<Arc<Vec<bool>>>,
    /// The shown triangles of the surface, ascending.
    pub(crate) triangles: Option<Arc<Vec<u32>>>,
    /// For each surface vertex, true if some triangle shows it.
    shown: Option<Vec<bool>>,
    /// For each surface vertex, true if it is locked.
    locked: Option<Vec<bool>>,
}

impl VertexAccess {
    pub(crate) fn of(access: &Access, model: &Model) -> Self {
        let drawn = access.shown_triangles(model);
        let triangles = drawn.as_ref().map(|drawn| {
            let of_surface = model.drawn.triangle_of_surface().iter().zip(0..);
            let shown = of_surface.filter(|(triangle, _)| drawn[**triangle as usize]);
            Arc::new(shown.map(|(_, number)| number).collect::<Vec<u32>>())
        });
        Self {
            shown: drawn.as_ref().map(|drawn| model.vertices_of_triangles(drawn)),
            locked: access.locked_vertices(model),
            triangles,
            drawn: drawn.map(Arc::new),
        }
    }

    /// Returns true if a triangle of the surface is shown.
    pub(crate) fn shows_triangle(&self, surface_triangle: u32) -> bool {
        let shown = self.triangles.as_ref();
        shown.is_none_or(|shown| shown.binary_search(&surface_triangle).is_ok())
    }

    /// Returns true if a vertex is visible.
    pub(crate) fn is_shown(&self, vertex: usize) -> bool {
        self.shown.as_ref().is_none_or(|shown| shown[vertex])
    }

    /// Returns true if any vertex is locked.
    pub(crate) fn locks_any(&self) -> bool {
        self.locked.is_some()
    }

    /// Returns true if a lock holds a vertex.
    pub(crate) fn is_locked(&self, vertex: usize) -> bool {
        self.locked.as_ref().is_some_and(|locked| locked[vertex])
    }

    /// Returns true if a vertex may be painted.
    pub(crate) fn may_be_painted(&self, vertex: usize) -> bool {
        self.is_shown(vertex) && !self.is_locked(vertex)
    }

    /// Returns true if every vertex may be painted.
    pub(crate) fn opens_all(&self) -> bool {
        self.shown.is_none() && self.locked.is_none()
    }
}
