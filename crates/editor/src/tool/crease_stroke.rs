//! A stroke along a crease or a border: a job finds the one that it means, and the surface beside it becomes a handle that
//! follows a curve along it.

use glam::{DVec2, DVec3};
use pliant_mesh::{SurfaceVertex, feature_line};

use super::context::Context;
use super::drawn_path::{DrawnPath, STEP_PX};
use super::sought_stroke::{Drawing, Outcome, SoughtStroke};
use crate::crease;
use crate::document::{Crease, HandleCurve, HandleLine, Reach};
use crate::evenly::evenly;
use crate::input::Pointer;
use crate::jobs::Enclosed;
use crate::region::displaced;
use crate::view::View;
use crate::workspace::Workspace;

/// A stroke during its drawing.
#[derive(Debug)]
pub(crate) struct CreaseStroke {
    path: DrawnPath,
    radius_px: f64,
    /// The width of the crease in world units, while a job searches for its line.
    width: Option<f64>,
}

impl CreaseStroke {
    pub(super) fn begin(context: &mut Context<'_>, pointer: Pointer) -> Option<SoughtStroke<Self>> {
        let drawing = Self {
            path: DrawnPath::begin(pointer, STEP_PX),
            radius_px: context.settings.brush().radius_px,
            width: None,
        };
        SoughtStroke::of_new_handle(context, pointer, drawing)
    }

    /// The vertices under the stroke, and the radius of the brush in world units where the surface is nearest.
    fn under(&self, workspace: &Workspace, view: &View) -> Option<(Vec<SurfaceVertex>, f64)> {
        let picking = workspace.picking(view)?;
        let points_px = self.path.evenly_px(STEP_PX);
        let picks = points_px.filter_map(|px| picking.along(picking.camera.ray(px, picking.viewport_px)));
        let (mut vertices, mut width) = (Vec::new(), f64::INFINITY);
        for pick in picks {
            vertices.push(pick.vertex);
            width = width.min(self.radius_px * picking.camera.world_per_px(pick.point, picking.viewport_px));
        }
        vertices.dedup();
        (!vertices.is_empty()).then_some((vertices, width))
    }

    /// The curve along a line of vertices.
    fn curve(&self, line: &[DVec3], width: f64) -> Option<HandleCurve> {
        let points = evenly(line, self.path.point_count(), self.path.is_closed());
        let curve = HandleCurve::at_rest_through(points, self.path.is_closed()).ok()?;
        Some(curve.creased(Some(Crease::new(width, 0.0).ok()?)))
    }
}

impl Drawing for CreaseStroke {
    fn status(&self) -> Option<String> {
        Some(match self.width {
            None => {
                "Drawing along a crease or a border: release at its end, or at its start to close it, Esc to cancel"
                    .to_owned()
            }
            Some(_) => "Finding the crease that the line means: Esc to cancel".to_owned(),
        })
    }

    fn outline_px(&self) -> Vec<DVec2> {
        self.path.as_outline_px()
    }

    fn is_looking(&self) -> bool {
        self.width.is_some()
    }

    fn holds_camera(&self) -> bool {
        true
    }

    fn moved(&mut self, _: &mut Context<'_>, pointer: Pointer) {
        self.path.follow(pointer);
    }

    fn released(&mut self, context: &mut Context<'_>) -> Outcome {
        let under = self.under(context.workspace, context.view);
        let (Some((stroke, width)), Some(model)) = (under, context.workspace.model().cloned()) else {
            return Outcome::Refuses("There is no surface under the line: draw it along a crease.");
        };
        let displacements = context.workspace.document.from_file().clone();
        let is_closed = self.path.is_closed();
        let work = Box::new(move |_: &_, cancel: &pliant_mesh::Cancel| {
            cancel.check()?;
            let surface = displaced(&model.surface, &displacements);
            let line = feature_line(&surface, &model.topology, &stroke, is_closed, width);
            Ok(line.unwrap_or_default().into())
        });
        context.workspace.jobs.ask(|slots| &mut slots.enclose, work);
        self.width = Some(width);
        Outcome::Looks
    }

    fn found(&mut self, context: &mut Context<'_>, found: Enclosed) -> Outcome {
        let workspace = &*context.workspace;
        let line = found.vertices;
        let places: Vec<DVec3> = line.iter().map(|&vertex| workspace.position(vertex)).collect();
        let width = self.width.take();
        let curve = width.and_then(|width| self.curve(&places, width));
        let (Some(width), Some(curve), Some(model)) = (width, curve, workspace.model()) else {
            return Outcome::Refuses(
                "There is no crease or border along the line: draw nearer to one, or make the brush larger.",
            );
        };
        let position = |vertex| workspace.position(vertex);
        let line = line.into_iter();
        let vertices = crease::beside(&model.surface, &model.topology, position, line, width);
        let vertices = vertices.into_iter();
        let is_open = |vertex: &SurfaceVertex| workspace.vertex_access.may_be_painted(vertex.index());
        let vertices: Vec<SurfaceVertex> = vertices.filter(is_open).collect();
        Outcome::Ends(Box::new(move |stroke, workspace| {
            stroke.take_with_line(workspace, vertices, HandleLine::Curve(curve), Reach::Length(width));
        }))
    }
}
