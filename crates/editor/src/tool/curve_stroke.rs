//! A stroke that draws a curve: when the button goes up, the surface under or around it becomes a handle that follows it.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use pliant_mesh::{Curve, SurfaceVertex, triangles_under};

use super::context::Context;
use super::drawn_path::{DrawnPath, STEP_PX};
use super::gesture::{Gesture, Next};
use super::mode::StrokeShape;
use super::overlay::Lit;
use super::paint::PaintStroke;
use super::spine::{Sample, around, to_the_middle};
use super::stroke::StrokeGesture;
use crate::document::{HandleCurve, HandleLine};
use crate::evenly::evenly;
use crate::input::{Button, Pointer};
use crate::jobs::Activity;
use crate::view::{Cursor, Picking, View};
use crate::workspace::Workspace;

const SPINE_POINTS: usize = 5;

/// The reach of a spine in half thicknesses, and that of a curve on the surface in its lengths.
const SPINE_REACH: f64 = 2.5;
const CURVE_REACH: f64 = 0.4;

/// A stroke during its drawing.
#[derive(Debug)]
pub(crate) struct CurveStroke {
    shape: StrokeShape,
    path: DrawnPath,
    /// The stroke that finally paints the vertices.
    stroke: StrokeGesture<PaintStroke>,
}

/// The result of a stroke.
struct Drawn {
    curve: HandleCurve,
    /// The vertices that follow it.
    vertices: Vec<SurfaceVertex>,
    /// The length within which the surface beside them follows.
    reach: f64,
}

impl CurveStroke {
    pub(super) fn begin(context: &mut Context<'_>, pointer: Pointer, shape: StrokeShape) -> Option<Self> {
        context.workspace.selection.wants_new_handle = true;
        let stroke = PaintStroke::begin(context.workspace, context.settings, pointer)?;
        Some(Self {
            shape,
            path: DrawnPath::begin(pointer, STEP_PX),
            stroke,
        })
    }

    /// The samples on the surface, evenly along the stroke.
    fn samples(&self, picking: &Picking<'_>) -> Vec<Sample> {
        let points_px = self.path.evenly_px(STEP_PX);
        points_px.filter_map(|px| self.sample(picking, px)).collect()
    }

    fn sample(&self, picking: &Picking<'_>, px: DVec2) -> Option<Sample> {
        let ray = picking.camera.ray(px, picking.viewport_px);
        let pick = picking.along(ray)?;
        match self.shape {
            StrokeShape::Spine => Some(Sample::inside(picking, pick, ray)),
            _ => Some(Sample::on(pick)),
        }
    }

    /// The curve with its surroundings; `None` if the stroke is too short for one.
    fn drawn(&self, workspace: &Workspace, view: &View) -> Option<Drawn> {
        let picking = workspace.picking(view)?;
        let mut samples = self.samples(&picking);
        let is_closed = self.shape == StrokeShape::Curve && self.path.is_closed();
        let count = match self.shape {
            StrokeShape::Spine => SPINE_POINTS,
            _ => self.path.point_count(),
        };
        let half = match self.shape {
            StrokeShape::Spine => to_the_middle(&mut samples, &picking),
            _ => 0.0,
        };
        let places: Vec<DVec3> = samples.iter().map(|sample| sample.point).collect();
        let points = evenly(&places, count, is_closed);
        let curve = HandleCurve::at_rest_through(points, is_closed).ok()?;
        let (vertices, reach) = match self.shape {
            StrokeShape::Spine => (around(curve.rest(), half, &samples, &picking), SPINE_REACH * half),
            _ => (
                under(curve.rest(), &samples, &picking),
                CURVE_REACH * curve.rest().length(),
            ),
        };
        (!vertices.is_empty()).then_some(Drawn { curve, vertices, reach })
    }
}

/// The corners of the triangles under a curve on the surface.
fn under(curve: &Curve, samples: &[Sample], picking: &Picking<'_>) -> Vec<SurfaceVertex> {
    let triangles = &picking.model.surface.triangles;
    let mut found: Vec<u32> = samples.iter().map(|sample| sample.pick.triangle).collect();
    // The hierarchy of the shown parts has numbers of its own, and that of an earlier shape has another surface.
    if picking.is_current && picking.triangles.is_none() {
        found.extend(triangles_under(curve, picking.bvh, triangles));
    }
    let corners = found.into_iter().flat_map(|triangle| triangles[triangle as usize]);
    let vertices: BTreeSet<SurfaceVertex> = corners.collect();
    vertices.into_iter().collect()
}

impl Gesture for CurveStroke {
    fn activity(&self) -> Activity {
        self.stroke.activity()
    }

    fn cursor(&self) -> Cursor {
        self.stroke.cursor()
    }

    fn lit(&self) -> Lit {
        self.stroke.lit()
    }

    fn status(&self, _: &Workspace, _: &View) -> Option<String> {
        Some(match self.shape {
            StrokeShape::Spine => {
                "Drawing a spine from the body to the tip: release at the end, Esc to cancel".to_owned()
            }
            _ => "Drawing a curve on the surface: release at its end, or at its start to close it, Esc to cancel"
                .to_owned(),
        })
    }

    fn outline_px(&self) -> Vec<DVec2> {
        self.path.as_outline_px()
    }

    fn moved(&mut self, _: &mut Context<'_>, pointer: Pointer) -> Next {
        self.path.follow(pointer);
        Next::Stay
    }

    fn released(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        if button != Button::Primary {
            return Next::Stay;
        }
        self.moved(context, pointer);
        let Some(drawn) = self.drawn(context.workspace, context.view) else {
            self.stroke.abort(context);
            context
                .workspace
                .refuse("That is too short for a curve: draw a longer one along the surface.");
            return Next::End;
        };
        self.stroke.finish_with(context.workspace, |stroke, workspace| {
            stroke.take_with_line(workspace, drawn.vertices, HandleLine::Curve(drawn.curve), drawn.reach);
        });
        Next::End
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        self.stroke.abort(context);
    }
}
