//! A drag that moves the surface with the pointer, in the plane of the screen.

use glam::{DMat3, DVec2, DVec3};
use pliant_mesh::SurfaceVertex;

use super::kelvinlet::Kelvinlet;
use crate::document::Document;
use crate::input::Pointer;
use crate::tool::constraint::on_plane;
use crate::tool::context::Context;
use crate::tool::stroke::{Stroke, StrokeGesture};
use crate::view::{Cursor, Pick};
use crate::workspace::Workspace;

/// The grabbed part.
#[derive(Debug)]
pub(super) struct GrabShape {
    grip: DVec3,
    start_px: DVec2,
    /// The moving vertices, with their positions in the shape and the matrix from the grip's displacement to theirs.
    taken: Vec<(SurfaceVertex, DVec3, DMat3)>,
}

impl GrabShape {
    /// Grabs the surface under the pointer: its connected part, and with symmetry that of the other side.
    pub fn begin(context: &mut Context<'_>, pointer: Pointer, pick: &Pick) -> StrokeGesture<Self> {
        let radius = context.settings.brush().radius_px
            * context
                .view
                .camera()
                .world_per_px(pick.point, context.view.viewport_px());
        let workspace = &mut *context.workspace;
        let transaction = workspace.begin_stroke("Grab shape");
        let own = Kelvinlet::new(pick.point, radius);
        let mirrored = workspace.both_sides().map(|sides| {
            let plane = sides.plane;
            let other = Kelvinlet::new(plane.mirrored(pick.point), radius);
            // Near the plane both sides pull at the grip, which must follow the pointer.
            let within = plane.normal().any_orthonormal_vector();
            let share = 1.0 + within.dot(other.at(pick.point) * within);
            (other, plane.reflection(), share.recip())
        });
        let shape = workspace.document.from_rest();
        let mut part = workspace.part_of(pick.vertex);
        if let Some(sides) = workspace.both_sides() {
            part.extend(sides.opposite(part.clone()));
            part.sort_unstable();
            part.dedup();
        }
        let open = part
            .into_iter()
            .filter(|vertex| workspace.vertex_access.may_be_painted(vertex.index()));
        let take = |vertex: SurfaceVertex| {
            let position = workspace.position(vertex);
            let mut effect = own.at(position);
            if let Some((other, reflection, share)) = &mirrored {
                effect = (effect + other.at(position) * *reflection) * *share;
            }
            (vertex, shape[vertex.index()], effect)
        };
        let stroke = Self {
            taken: open.map(take).collect(),
            grip: pick.point,
            start_px: pointer.position_px,
        };
        StrokeGesture::new(transaction, stroke, pointer)
    }
}

impl Stroke for GrabShape {
    fn doing(&self, _: &Workspace) -> String {
        "Grabbing the shape".to_owned()
    }

    fn cursor(&self) -> Cursor {
        Cursor::Grabbing
    }

    fn holds_camera(&self) -> bool {
        true
    }

    fn dab(&mut self, context: &mut Context<'_>, _: &Document, [_, to_px]: [DVec2; 2]) {
        let (camera, viewport_px) = (context.view.camera(), context.view.viewport_px());
        let [from, to] =
            [self.start_px, to_px].map(|px| on_plane(camera.ray(px, viewport_px), self.grip, camera.forward()));
        let (Some(from), Some(to)) = (from, to) else { return };
        let way = to - from;
        context.workspace.document.correct(|shape| {
            for (vertex, start, effect) in &self.taken {
                shape[vertex.index()] = *start + *effect * way;
            }
        });
    }
}
