//! A curve drawn on the surface, along which it is cut.
//!
//! A curve is closed if it ends where it began or crosses itself there, and also if it begins and ends beside the
//! shape: then it goes on behind the limb that it crosses. Otherwise both of its ends are at a border.

use glam::{DVec2, DVec3};

use super::context::Context;
use super::cut_side::CutSide;
use super::drawn_path::{CLOSING_PX, DrawnPath, STEP_PX};
use super::gesture::{Gesture, Next};
use super::overlay::Lit;
use super::polyline::{crossed_loop, length_px, simplified};
use crate::cut::{CutCurve, CutSight, KeptSide};
use crate::input::{Button, Pointer};
use crate::stitching::MeshChange;
use crate::view::{Cursor, Picking, Projection, Ray, View, distance_to_segment};
use crate::workspace::Workspace;

/// The curve may leave its samples by this distance, in points.
const SLACK_PX: f64 = 0.75;
/// A shorter curve, in points, is none.
const SHORTEST_PX: f64 = 40.0;
/// A loop that is at least this share of the whole curve is the curve; its tails are left out.
const MOST: f64 = 0.7;

/// A loop goes on behind the shape, too, if the way between its first and last point there is at least this share of
/// its length on the shape: it was drawn around a limb.
const AROUND: f64 = 0.5;

/// A curve during its drawing.
#[derive(Debug)]
pub(crate) struct CutCurveStroke {
    path: DrawnPath,
    side: CutSide,
}

impl CutCurveStroke {
    pub(super) fn begin(workspace: &Workspace, pointer: Pointer, kept: KeptSide) -> Self {
        Self {
            path: DrawnPath::begin(pointer, STEP_PX),
            side: CutSide::begin(workspace, pointer, kept),
        }
    }

    fn follow(&mut self, pointer: Pointer) {
        self.path.follow(pointer);
        self.side.follow(pointer);
    }

    /// The curve on the present surface; `None` if it is too short, or beside the shape.
    fn curve(&self, workspace: &Workspace, view: &View) -> Option<CutCurve> {
        let drawn = self.path.points_px();
        let whole = length_px(drawn);
        if whole < SHORTEST_PX {
            return None;
        }
        let crossed = crossed_loop(drawn).filter(|own| length_px(own) >= MOST * whole);
        let (first, last) = (*drawn.first()?, *drawn.last()?);
        let is_loop = crossed.is_some() || first.distance(last) <= CLOSING_PX;
        let mut line = crossed.unwrap_or_else(|| drawn.to_vec());
        if is_loop {
            line.push(line[0]);
        }
        let runs = runs(&line, workspace, view)?;
        let points: Vec<DVec2> = runs.iter().flat_map(|run| simplified(run, SLACK_PX)).collect();
        let (&first, &last) = (points.first()?, points.last()?);
        let is_beside = |end: DVec2, drawn: DVec2| end != drawn && !is_near_border(end, workspace, view);
        let is_across = is_beside(first, line[0]) && is_beside(last, line[line.len() - 1]);
        let on_shape: f64 = runs.iter().map(|run| length_px(run)).sum();
        let is_around = is_across || (is_loop && first.distance(last) >= AROUND * on_shape);
        let picking = workspace.picking(view)?;
        let at = |px: &DVec2| Some(picking.along(picking.camera.ray(*px, picking.viewport_px))?.point);
        let mut points: Vec<DVec3> = points.iter().filter_map(at).collect();
        points.dedup();
        if is_loop && points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        if is_around {
            points.extend(behind([last, first], workspace, &picking));
        }
        let camera = view.camera();
        Some(CutCurve {
            points,
            is_closed: is_loop || is_across,
            sight: match camera.projection {
                Projection::Perspective => CutSight::From(camera.eye()),
                Projection::Orthographic => CutSight::Along(camera.forward()),
            },
        })
    }
}

/// Points on the farthest side of the shape, behind a line over the view.
fn behind(line: [DVec2; 2], workspace: &Workspace, picking: &Picking<'_>) -> Vec<DVec3> {
    let bounds = workspace.model().and_then(|model| model.bounds());
    let Some(bounds) = bounds else { return Vec::new() };
    let at = |share: f64| {
        let ray = picking.camera.ray(line[0].lerp(line[1], share), picking.viewport_px);
        let beyond = 2.0 * (bounds.diagonal() + ray.origin.distance(bounds.centre()));
        let back = Ray {
            origin: ray.origin + beyond * ray.direction,
            direction: -ray.direction,
        };
        picking.along(back).map(|pick| pick.point)
    };
    [0.25, 0.5, 0.75].into_iter().filter_map(at).collect()
}

/// The runs of a line over the view that are on the shape, evenly sampled.
fn runs(line: &[DVec2], workspace: &Workspace, view: &View) -> Option<Vec<Vec<DVec2>>> {
    let picking = workspace.picking(view)?;
    let is_on = |px: DVec2| picking.along(picking.camera.ray(px, picking.viewport_px)).is_some();
    let mut runs: Vec<Vec<DVec2>> = Vec::new();
    let mut was_on = false;
    let mut take = |px: DVec2| {
        let is_on = is_on(px);
        match runs.last_mut() {
            Some(run) if is_on && was_on => run.push(px),
            _ if is_on => runs.push(vec![px]),
            _ => {}
        }
        was_on = is_on;
    };
    for pair in line.windows(2) {
        let steps = (pair[0].distance(pair[1]) / STEP_PX).ceil().max(1.0);
        (0..steps as usize).for_each(|step| take(pair[0].lerp(pair[1], step as f64 / steps)));
    }
    line.last().copied().into_iter().for_each(&mut take);
    Some(runs)
}

/// Returns true if a border of the surface is near a place of the view.
fn is_near_border(px: DVec2, workspace: &Workspace, view: &View) -> bool {
    let Some(model) = workspace.model() else { return false };
    let (camera, viewport_px) = (view.camera(), view.viewport_px());
    let mut edges = model.topology.boundary_edge_list().iter();
    edges.any(|ends| {
        let [a, b] = ends.map(|end| camera.project(workspace.position(end), viewport_px));
        a.zip(b)
            .is_some_and(|(a, b)| distance_to_segment(px, a, b) <= CLOSING_PX)
    })
}

impl Gesture for CutCurveStroke {
    fn cursor(&self) -> Cursor {
        Cursor::Brush
    }

    fn lit(&self) -> Lit {
        Lit::Gizmo(None)
    }

    fn status(&self, _: &Workspace, _: &View) -> Option<String> {
        Some(self.side.status("curve"))
    }

    /// There and back, because an outline is closed.
    fn outline_px(&self) -> Vec<DVec2> {
        let line = self.path.points_px();
        let back = line.iter().rev().copied();
        self.side.marked_px(line).into_iter().chain(back).collect()
    }

    fn moved(&mut self, _: &mut Context<'_>, pointer: Pointer) -> Next {
        self.follow(pointer);
        Next::Stay
    }

    fn released(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        if button != Button::Primary {
            return Next::Stay;
        }
        self.follow(pointer);
        let Some(curve) = self.curve(context.workspace, context.view) else {
            let why = "That is too short for a curve, or beside the shape: draw a longer one along the surface.";
            context.workspace.refuse(why);
            return Next::End;
        };
        self.side
            .cut(context, |kept, spared| MeshChange::CutAlong(curve, kept, spared));
        Next::End
    }

    fn abort(&mut self, _: &mut Context<'_>) {}
}
