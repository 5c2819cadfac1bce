//! A drag that moves the surface with the pointer, in the plane of the screen.
//!
//! A long drag is a flow: in each of its steps the grab is where the pointer has brought it, and moves what is there.
//! One step alone would fold the surface where it is steeper than the brush is wide.

use glam::{DVec2, DVec3};
use pliant_mesh::{MirrorPlane, SurfaceVertex};
use rayon::prelude::*;

use super::kelvinlet::Kelvinlet;
use crate::document::Document;
use crate::input::Pointer;
use crate::tool::constraint::on_plane;
use crate::tool::context::Context;
use crate::tool::stroke::{Stroke, StrokeGesture};
use crate::view::{Cursor, Pick};
use crate::workspace::{Workspace, carry_corrections};

/// The longest step of the flow in radii of the brush: a step of one radius would fold.
const STEP: f64 = 0.4;

/// Vertices farther away than this many radii, which hardly move, take a single step.
const FAR: f64 = 8.0;

/// The grabbed part.
#[derive(Debug)]
pub(super) struct GrabShape {
    grip: DVec3,
    radius: f64,
    /// With symmetry, the plane to whose other side the grab is mirrored.
    plane: Option<MirrorPlane>,
    start_px: DVec2,
    /// The moving vertices, with their displacements in the shape and their positions.
    taken: Vec<(SurfaceVertex, DVec3, DVec3)>,
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
        let take = |vertex: SurfaceVertex| (vertex, shape[vertex.index()], workspace.position(vertex));
        let stroke = Self {
            taken: open.map(take).collect(),
            plane: workspace.both_sides().map(|sides| sides.plane),
            grip: pick.point,
            radius,
            start_px: pointer.position_px,
        };
        StrokeGesture::new(transaction, stroke, pointer)
    }

    /// The displacement of each position by a pull of `way` at `grip`.
    fn pull(&self, grip: DVec3, way: DVec3) -> impl Fn(DVec3) -> DVec3 + Sync + use<> {
        let own = Kelvinlet::new(grip, self.radius);
        let mirrored = self.plane.map(|plane| {
            let other = Kelvinlet::new(plane.mirrored(grip), self.radius);
            // Near the plane both sides pull at the grip, which must follow the pointer.
            let within = plane.normal().any_orthonormal_vector();
            let share = 1.0 + within.dot(other.at(grip) * within);
            (other, plane.reflection(), share.recip())
        });
        move |position| {
            let mut effect = own.at(position);
            if let Some((other, reflection, share)) = &mirrored {
                effect = (effect + other.at(position) * *reflection) * *share;
            }
            effect * way
        }
    }

    /// The displacement of each taken vertex while the grip moves by `way`.
    fn pulled(&self, way: DVec3) -> Vec<DVec3> {
        let steps = (way.length() / (STEP * self.radius)).ceil().max(1.0);
        let pulls: Vec<_> = (0..steps as u32)
            .map(|step| self.pull(self.grip + way * (f64::from(step) / steps), way / steps))
            .collect();
        let whole = self.pull(self.grip, way);
        let near = FAR * self.radius + way.length();
        let mirrored = self.plane.map(|plane| plane.mirrored(self.grip));
        let is_near = |position: DVec3| {
            let grips = [Some(self.grip), mirrored];
            grips.into_iter().flatten().any(|grip| grip.distance(position) <= near)
        };
        let moved = self.taken.par_iter().map(|&(_, _, start)| {
            if !is_near(start) {
                return whole(start);
            }
            let end = pulls.iter().fold(start, |position, pull| position + pull(position));
            end - start
        });
        moved.collect()
    }
}

impl Stroke for GrabShape {
    fn doing(&self, _: &Workspace) -> String {
        "Grabbing the shape".to_owned()
    }

    fn finish(&mut self, workspace: &mut Workspace, before: &Document) {
        carry_corrections(workspace, before);
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
        let pulled = self.pulled(to - from);
        context.workspace.document.correct(|shape| {
            for ((vertex, start, _), moved) in self.taken.iter().zip(pulled) {
                shape[vertex.index()] = *start + moved;
            }
        });
    }
}
