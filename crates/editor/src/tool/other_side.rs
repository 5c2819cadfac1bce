//! A stroke's paint on the other side of the plane of symmetry.
//!
//! Roles are painted alike on both sides. A handle has a twin there with the mirrored motion, unless it is on both
//! sides of the plane: then both sides are one handle.

use std::sync::Arc;

use pliant_mesh::SurfaceVertex;

use crate::document::{HandleId, Paint, link_twins};
use crate::jobs::BothSides;
use crate::workspace::{Workspace, members, twin_across};

/// The other side of an active stroke.
#[derive(Debug)]
pub(super) struct OtherSide {
    sides: Arc<BothSides>,
    /// The paint there; decided by the first vertices of the stroke.
    paint: Option<Paint>,
    /// The twin that this stroke has made.
    made: Option<HandleId>,
}

impl OtherSide {
    /// The other side of a stroke that begins; `None` without symmetry.
    pub(super) fn of(workspace: &Workspace) -> Option<Self> {
        let sides = Arc::clone(workspace.both_sides()?);
        Some(Self {
            sides,
            paint: None,
            made: None,
        })
    }

    /// The vertices to paint on the other side when `vertices` are painted with `own`, and their paint.
    pub(super) fn of_painted(
        &mut self,
        workspace: &mut Workspace,
        own: Paint,
        vertices: &[SurfaceVertex],
    ) -> (Vec<SurfaceVertex>, Paint) {
        let mut opposite = Vec::new();
        if let Paint::Handle(id) = own
            && self.paint.is_none()
            && !vertices.is_empty()
        {
            let had = workspace
                .document
                .handle(id)
                .is_some_and(|handle| handle.twin.is_some());
            match twin_across(workspace, &self.sides, id, vertices) {
                Some((twin, former)) => {
                    self.paint = Some(Paint::Handle(twin));
                    self.made = (!had).then_some(twin);
                    opposite = former;
                }
                None => self.paint = Some(own),
            }
        }
        self.join_where_they_meet(workspace, own, vertices);
        let paint = self.paint.unwrap_or(own);
        opposite.extend(self.sides.opposite(vertices.iter().copied()));
        opposite.sort_unstable();
        opposite.dedup();
        // The brush decides if both would paint.
        let document = &workspace.document;
        opposite.retain(|vertex| document.paint()[vertex.index()] != own && vertices.binary_search(vertex).is_err());
        (opposite, paint)
    }

    /// Returns true if the vertices, where they are shown, are all on one side of the plane.
    pub(super) fn is_beyond(&self, workspace: &Workspace, vertices: &[SurfaceVertex]) -> bool {
        let plane = &self.sides.plane;
        let mut beyond = vertices
            .iter()
            .map(|&vertex| plane.normal().dot(workspace.position(vertex)) - plane.distance());
        let first = beyond.next().unwrap_or_default();
        first != 0.0 && beyond.all(|other| other * first > 0.0)
    }

    /// A stroke that reaches the twin that it has made itself crosses the plane: both become one handle.
    fn join_where_they_meet(&mut self, workspace: &mut Workspace, own: Paint, vertices: &[SurfaceVertex]) {
        let Some(twin) = self.made else { return };
        let document = &mut workspace.document;
        let is_twins = |vertex: &SurfaceVertex| document.paint()[vertex.index()] == Paint::Handle(twin);
        if vertices.iter().any(is_twins) {
            let joined = members(document, twin);
            document.paint_vertices(joined.into_iter().map(|vertex| (vertex, own)));
            self.paint = Some(own);
            self.made = None;
        }
    }

    /// Links the twin that was made, once both handles have their vertices.
    pub(super) fn finish(&self, workspace: &mut Workspace, own: Paint) {
        let document = &mut workspace.document;
        if let (Paint::Handle(id), Some(twin)) = (own, self.made)
            && document.handle(id).is_some()
            && document.handle(twin).is_some()
        {
            link_twins(document, id, twin, self.sides.plane);
        }
    }
}
