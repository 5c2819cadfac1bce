//! A drag that takes the surface along with the pointer, in the plane of the screen.

use glam::{DMat3, DVec2, DVec3};
use pliant_mesh::SurfaceVertex;

use super::kelvinlet::Kelvinlet;
use crate::document::Transaction;
use crate::input::{Button, Pointer};
use crate::jobs::Activity;
use crate::scene_view::Cursor;
use crate::tool::constraint::on_plane;
use crate::tool::context::Context;
use crate::tool::gesture::{Gesture, Next};
use crate::tool::overlay::Lit;
use crate::view::{Pick, View};
use crate::workspace::Workspace;

/// A drag that goes on.
#[derive(Debug)]
pub(super) struct GrabShape {
    transaction: Transaction,
    grip: DVec3,
    start_px: DVec2,
    /// The vertices that go along, with where they were in the shape and what takes the grip's way to theirs.
    taken: Vec<(SurfaceVertex, DVec3, DMat3)>,
}

impl GrabShape {
    /// Takes hold of the surface under the pointer: of the part that hangs together with it, and with symmetry of the other
    /// side's.
    pub fn begin(context: &mut Context<'_>, pointer: Pointer, pick: &Pick) -> Self {
        let radius = context.settings.brush.radius_px
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
            // Near the plane both sides pull at the grip, which is to go as far as the pointer.
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
        Self {
            taken: open.map(take).collect(),
            transaction,
            grip: pick.point,
            start_px: pointer.position_px,
        }
    }

    fn follow(&self, context: &mut Context<'_>, to_px: DVec2) {
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

impl Gesture for GrabShape {
    fn activity(&self) -> Activity {
        Activity::Painting
    }

    fn cursor(&self) -> Cursor {
        Cursor::Grabbing
    }

    fn lit(&self) -> Lit {
        Lit::Ring
    }

    fn status(&self, _: &Workspace, _: &View) -> Option<String> {
        Some("Taking the surface along: Esc takes it back".to_owned())
    }

    fn holds_camera(&self) -> bool {
        true
    }

    fn moved(&mut self, context: &mut Context<'_>, pointer: Pointer) -> Next {
        self.follow(context, pointer.position_px);
        Next::Stay
    }

    fn released(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        if button != Button::Primary {
            return Next::Stay;
        }
        if pointer.position_px != self.start_px {
            self.follow(context, pointer.position_px);
        }
        context.workspace.commit(&self.transaction);
        Next::End
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        context.workspace.abort(&self.transaction);
    }
}
