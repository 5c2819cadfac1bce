//! A stroke's paint on the other side of the plane of symmetry.
//!
//! Roles are painted alike on both sides. A handle has a twin there with the mirrored motion, unless it is on both
//! sides of the plane: then both sides are one handle.

use std::sync::Arc;

use pliant_mesh::SurfaceVertex;

use super::halves::{Half, Halves, NO_TWIN, State, is_twin};
use super::one_piece::{in_pieces, pieces};
use super::smooth_image::smooth_image;
use crate::document::{Document, HandleId, Paint, link_twins};
use crate::jobs::BothSides;
use crate::region::handle_radius;
use crate::workspace::{Workspace, members};

/// The shape is not its own mirror image where more than this share of the places on the other side are uncertain.
const UNCERTAIN: f64 = 0.25;

/// The other side of an active stroke.
#[derive(Debug)]
pub(super) struct OtherSide {
    sides: Arc<BothSides>,
    /// The painted handle's vertices on both sides, from the stroke's first vertices on.
    halves: Option<Halves>,
    /// The painted handle's twin.
    twin: Option<HandleId>,
    /// Whether this stroke has made the twin.
    is_made: bool,
}

impl OtherSide {
    /// The other side of a stroke that begins; `None` without symmetry.
    pub(super) fn of(workspace: &Workspace) -> Option<Self> {
        let sides = Arc::clone(workspace.both_sides()?);
        Some(Self {
            sides,
            halves: None,
            twin: None,
            is_made: false,
        })
    }

    /// The vertices to paint on both sides when `vertices` are painted with `own`, each with its paint.
    pub(super) fn of_painted(
        &mut self,
        workspace: &mut Workspace,
        own: Paint,
        vertices: &[SurfaceVertex],
    ) -> Vec<(Vec<SurfaceVertex>, Paint)> {
        match own {
            Paint::Handle(id) if !vertices.is_empty() => self.of_handle(workspace, id, vertices),
            _ => {
                let mut all = vertices.to_vec();
                all.extend(self.sides.opposite(vertices.iter().copied()));
                all.sort_unstable();
                all.dedup();
                vec![(all, own)]
            }
        }
    }

    fn of_handle(
        &mut self,
        workspace: &mut Workspace,
        id: HandleId,
        vertices: &[SurfaceVertex],
    ) -> Vec<(Vec<SurfaceVertex>, Paint)> {
        let Some(model) = workspace.model().cloned() else {
            return Vec::new();
        };
        let is_first = self.halves.is_none();
        let halves = self.halves.get_or_insert_with(|| {
            let former = workspace.document.handle(id).and_then(|handle| handle.twin);
            self.twin = former.map(|twin| twin.handle);
            let mut halves = Halves::of_nothing(Arc::clone(&self.sides), model, former.is_some());
            halves.give(&members(&workspace.document, id));
            halves
        });
        let (state, former) = (halves.state(), halves.given().len());
        let new = halves.give(vertices);
        // A handle without a twin gets one of all its vertices.
        let is_changed = is_first && self.twin.is_none() || halves.state() != state;
        let changed = if is_changed { &halves.given()[..former] } else { &[] };
        let are_one = halves.state() == State::One;
        if self.twin.is_none() && !are_one {
            self.twin = Some(workspace.document.add_handle());
            self.is_made = true;
        }
        let paint = workspace.document.paint();
        let is_of_another = |vertex: &SurfaceVertex| match paint[vertex.index()] {
            Paint::Handle(other) => other != id && Some(other) != self.twin,
            _ => false,
        };
        let mut around = halves.around(changed);
        around.retain(|(vertex, _)| !is_of_another(vertex));
        around.extend(halves.around(&new));
        let of = |half: Half| {
            let of_half = around.iter().filter(|(_, own)| *own == half);
            of_half.map(|(vertex, _)| *vertex).collect::<Vec<_>>()
        };
        let mut between = of(Half::Neither);
        between.retain(|vertex| matches!(paint[vertex.index()], Paint::Handle(_)) && !is_of_another(vertex));
        let mut painted = vec![(of(Half::Own), Paint::Handle(id)), (between, Paint::Bare)];
        painted.extend(self.twin.map(|twin| (of(Half::Twin), Paint::Handle(twin))));
        painted
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

    /// Takes what was painted on the other side off again, if the handle is all around a limb without it, and the shape is
    /// not its own mirror image there: it would only add rags.
    pub(super) fn drop_uncertain(&self, workspace: &mut Workspace, own: Paint, before: &Document) {
        let (Paint::Handle(id), Some(halves)) = (own, &self.halves) else {
            return;
        };
        let mut images = members(&workspace.document, id);
        images.retain(|vertex| !halves.is_given(*vertex));
        let uncertain = images.iter().filter(|vertex| halves.is_uncertain(**vertex)).count();
        let is_wrong = uncertain as f64 > UNCERTAIN * images.len() as f64;
        if halves.state() == State::One && halves.are_both_sides() && is_wrong {
            let dropped = images.into_iter().map(|vertex| (vertex, former(before, vertex)));
            let dropped: Vec<(SurfaceVertex, Paint)> = dropped.collect();
            workspace.document.paint_vertices(dropped);
        }
    }

    /// Smooths the rim of what was painted on the other side, where that is off by some edges, and closes the gaps
    /// between its pieces.
    pub(super) fn smooth(&self, workspace: &mut Workspace, own: Paint, before: &Document) {
        let (Paint::Handle(id), Some(halves), Some(model)) = (own, &self.halves, workspace.model().cloned()) else {
            return;
        };
        let image = match (halves.state(), self.twin) {
            (State::One, _) => id,
            (_, Some(twin)) if self.is_made => twin,
            _ => return,
        };
        let paint = Arc::clone(&workspace.document.paint);
        let is_in = |vertex: SurfaceVertex| paint[vertex.index()] == Paint::Handle(image);
        let may_change = |vertex: SurfaceVertex| {
            let is_another = matches!(paint[vertex.index()], Paint::Handle(_)) && !is_in(vertex);
            !is_another && halves.is_uncertain(vertex) && workspace.vertex_access.may_be_painted(vertex.index())
        };
        let vertices = members(&workspace.document, image);
        let mut changed = smooth_image(&model.topology, &vertices, is_in, may_change);
        if image != id {
            let mut smooth: Vec<SurfaceVertex> = vertices;
            smooth.retain(|vertex| changed.get(vertex) != Some(&false));
            smooth.extend(
                changed
                    .iter()
                    .filter(|(_, is_inside)| **is_inside)
                    .map(|(vertex, _)| *vertex),
            );
            let count = pieces(&model, &members(&workspace.document, id)).len();
            let radius = handle_radius(&model.surface, &model.topology, &smooth);
            changed.extend(in_pieces(&model, &smooth, count, radius, may_change));
        }
        let painted = changed.into_iter().map(|(vertex, is_inside)| match is_inside {
            true => (vertex, Paint::Handle(image)),
            false => (vertex, former(before, vertex)),
        });
        let painted: Vec<(SurfaceVertex, Paint)> = painted.collect();
        // A shared one would be copied.
        drop(paint);
        workspace.document.paint_vertices(painted);
    }

    /// Takes the paint of a twin that has hardly a vertex off again, because the other side lacks the part.
    pub(super) fn drop_scraps(&self, workspace: &mut Workspace, own: Paint, before: &Document) {
        let (Paint::Handle(id), Some(twin), Some(halves)) = (own, self.twin, &self.halves) else {
            return;
        };
        let scraps = members(&workspace.document, twin);
        let is_apart = self.is_made && halves.state() != State::One;
        if is_apart && !is_twin(scraps.len(), members(&workspace.document, id).len()) {
            let restored = scraps.into_iter().map(|vertex| (vertex, former(before, vertex)));
            let restored: Vec<(SurfaceVertex, Paint)> = restored.collect();
            workspace.document.paint_vertices(restored);
            workspace.refuse(NO_TWIN);
        }
    }

    /// Links the twin that was made, once both handles have their vertices.
    pub(super) fn finish(&self, workspace: &mut Workspace, own: Paint) {
        let document = &mut workspace.document;
        if let (Paint::Handle(id), Some(twin)) = (own, self.twin)
            && self.is_made
            && document.handle(id).is_some()
            && document.handle(twin).is_some()
        {
            link_twins(document, id, twin, self.sides.plane);
        }
    }
}

/// A vertex' paint before the stroke.
fn former(before: &Document, vertex: SurfaceVertex) -> Paint {
    before.paint()[vertex.index()]
}
