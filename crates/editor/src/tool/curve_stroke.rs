//! A stroke that draws a curve: when the button goes up, the surface under or around it becomes a handle that follows it.
//! A job finds the limb around a spine.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_mesh::{Curve, SurfaceVertex, triangles_under};

use super::context::Context;
use super::drawn_path::{DrawnPath, STEP_PX};
use super::mode::StrokeShape;
use super::sought_stroke::{Drawing, Outcome, SoughtStroke};
use super::spine::{Sample, around, to_the_middle};
use super::stroke_part::on_one_part;
use super::uncut_reach::uncut_reach;
use crate::document::{HandleCurve, HandleLine, Reach};
use crate::evenly::evenly;
use crate::input::Pointer;
use crate::jobs::Enclosed;
use crate::view::{Picking, View};
use crate::workspace::Workspace;

const SPINE_POINTS: usize = 5;

/// The least and the most reach of a spine in half thicknesses, and the reach of a curve on the surface in its lengths.
const SPINE_LEAST_REACH: f64 = 0.75;
const SPINE_REACH: f64 = 2.5;
const CURVE_REACH: f64 = 0.4;

/// A stroke during its drawing.
#[derive(Debug)]
pub(crate) struct CurveStroke {
    shape: StrokeShape,
    path: DrawnPath,
    /// The drawn spine, while a job searches for the limb around it.
    spine: Option<HandleCurve>,
}

/// The message if a stroke is too short for a curve.
const TOO_SHORT: &str = "That is too short for a curve: draw a longer one along the surface.";

/// What follows a curve.
enum Around {
    /// These vertices.
    Under(Vec<SurfaceVertex>),
    /// The limb of this half thickness around it, which is connected with these vertices.
    Limb(f64, Vec<SurfaceVertex>),
}

impl CurveStroke {
    pub(super) fn begin(context: &mut Context<'_>, pointer: Pointer, shape: StrokeShape) -> Option<SoughtStroke<Self>> {
        let drawing = Self {
            shape,
            path: DrawnPath::begin(pointer, STEP_PX),
            spine: None,
        };
        SoughtStroke::of_new_handle(context, pointer, drawing)
    }

    /// The samples on the surface, evenly along the stroke.
    fn samples(&self, picking: &Picking<'_>) -> Vec<Sample> {
        let places = self.path.evenly_px(STEP_PX).filter_map(|px| {
            let ray = picking.camera.ray(px, picking.viewport_px);
            Some((picking.along(ray)?, ray))
        });
        if self.shape != StrokeShape::Spine {
            return places.map(|(pick, _)| Sample::on(pick)).collect();
        }
        let places = on_one_part(places.collect(), picking).into_iter();
        places.map(|(pick, ray)| Sample::inside(picking, pick, ray)).collect()
    }

    /// The curve with what follows it; `None` if the stroke is too short for one.
    fn drawn(&self, workspace: &Workspace, view: &View) -> Option<(HandleCurve, Around)> {
        let picking = workspace.picking(view)?;
        let mut samples = self.samples(&picking);
        let is_closed = self.shape == StrokeShape::Curve && self.path.is_closed();
        let (count, half) = match self.shape {
            StrokeShape::Spine => (SPINE_POINTS, to_the_middle(&mut samples, &picking)),
            _ => (self.path.point_count(), 0.0),
        };
        let places: Vec<DVec3> = samples.iter().map(|sample| sample.point).collect();
        let points = evenly(&places, count, is_closed);
        let curve = HandleCurve::at_rest_through(points, is_closed).ok()?;
        if self.shape == StrokeShape::Spine {
            let seen = samples.iter().map(|sample| sample.pick.vertex).collect();
            return Some((curve, Around::Limb(half, seen)));
        }
        let under = under(curve.rest(), &samples, &picking);
        (!under.is_empty()).then_some((curve, Around::Under(under)))
    }

    /// Begins the search for the limb around a spine.
    fn look_around(&mut self, workspace: &mut Workspace, drawn: HandleCurve, half: f64, seen: Vec<SurfaceVertex>) {
        let Some(model) = workspace.model().cloned() else {
            return;
        };
        let (shape, curve) = (workspace.document.from_file().clone(), drawn.clone());
        let rest = Arc::clone(&workspace.document.rest);
        let work = Box::new(move |_: &_, cancel: &pliant_mesh::Cancel| {
            cancel.check()?;
            let vertices = around(curve.rest(), half, &seen, &model, &shape);
            let range = [SPINE_LEAST_REACH * half, SPINE_REACH * half];
            let reach = Some(uncut_reach(&model, &rest, &vertices, range, cancel)?);
            Ok(Enclosed { vertices, reach })
        });
        workspace.jobs.ask(|slots| &mut slots.enclose, work);
        self.spine = Some(drawn);
    }
}

/// A handle of these vertices that follows the curve.
fn handle(curve: HandleCurve, vertices: Vec<SurfaceVertex>, reach: Reach) -> Outcome {
    Outcome::Ends(Box::new(move |stroke, workspace| {
        stroke.take_with_line(workspace, vertices, HandleLine::Curve(curve), reach);
    }))
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

impl Drawing for CurveStroke {
    fn status(&self) -> Option<String> {
        Some(match self.shape {
            StrokeShape::Spine if self.spine.is_some() => "Finding the limb around the spine: Esc to cancel".to_owned(),
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

    fn is_looking(&self) -> bool {
        self.spine.is_some()
    }

    fn moved(&mut self, _: &mut Context<'_>, pointer: Pointer) {
        self.path.follow(pointer);
    }

    fn released(&mut self, context: &mut Context<'_>) -> Outcome {
        match self.drawn(context.workspace, context.view) {
            Some((curve, Around::Under(vertices))) => {
                let reach = Reach::Length(CURVE_REACH * curve.rest().length());
                handle(curve, vertices, reach)
            }
            Some((curve, Around::Limb(half, seen))) => {
                self.look_around(context.workspace, curve, half, seen);
                Outcome::Looks
            }
            None => Outcome::Refuses(TOO_SHORT),
        }
    }

    fn found(&mut self, _: &mut Context<'_>, limb: Enclosed) -> Outcome {
        match self.spine.take().zip(limb.reach) {
            Some((curve, reach)) if !limb.vertices.is_empty() => handle(curve, limb.vertices, Reach::Bounded(reach)),
            _ => Outcome::Refuses(TOO_SHORT),
        }
    }
}
