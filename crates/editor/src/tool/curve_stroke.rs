//! A stroke that draws a curve: when the button goes up, the surface under or around it becomes a handle that follows it.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use pliant_mesh::{Curve, SurfaceVertex, triangles_under};

use super::context::Context;
use super::gesture::{Gesture, Next};
use super::mode::StrokeShape;
use super::overlay::Lit;
use super::paint::PaintStroke;
use super::stroke::StrokeGesture;
use crate::document::{HandleCurve, HandleLine};
use crate::input::{Button, Pointer};
use crate::jobs::Activity;
use crate::view::{Cursor, Pick, Picking, Ray, View};
use crate::workspace::Workspace;

/// The distance between two samples of the stroke, in points.
const STEP_PX: f64 = 3.0;

/// Ends of a curve on the surface that are so near, in points, close it if it is this long at least.
const CLOSING_PX: f64 = 16.0;
const SHORTEST_CLOSED_PX: f64 = 120.0;

/// The way between two control points of a curve on the surface, in points, and their possible numbers.
const SPACING_PX: f64 = 60.0;
const CURVE_POINTS: std::ops::RangeInclusive<usize> = 3..=12;
const SPINE_POINTS: usize = 5;

/// The limb around a spine has the vertices within this many of its half thicknesses.
const GIRTH: f64 = 1.7;

/// The reach of a spine in half thicknesses, and that of a curve on the surface in its lengths.
const SPINE_REACH: f64 = 2.5;
const CURVE_REACH: f64 = 0.4;

/// A stroke during its drawing.
#[derive(Debug)]
pub(crate) struct CurveStroke {
    shape: StrokeShape,
    /// Samples in points of the view.
    points_px: Vec<DVec2>,
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

/// A sample of the stroke on the surface.
#[derive(Clone, Copy, Debug)]
struct Sample {
    pick: Pick,
    /// The point of the curve.
    point: DVec3,
    /// Half of the way through the limb.
    half: f64,
}

impl CurveStroke {
    pub(super) fn begin(context: &mut Context<'_>, pointer: Pointer, shape: StrokeShape) -> Option<Self> {
        context.workspace.selection.wants_new_handle = true;
        let stroke = PaintStroke::begin(context.workspace, context.settings, pointer)?;
        Some(Self {
            shape,
            points_px: vec![pointer.position_px],
            stroke,
        })
    }

    /// The samples on the surface, evenly along the stroke.
    fn samples(&self, picking: &Picking<'_>) -> Vec<Sample> {
        let mut samples = Vec::new();
        for pair in self.points_px.windows(2) {
            let steps = (pair[0].distance(pair[1]) / STEP_PX).ceil().max(1.0);
            for step in 0..steps as usize {
                let px = pair[0].lerp(pair[1], step as f64 / steps);
                samples.extend(self.sample(picking, px));
            }
        }
        samples.extend(self.points_px.last().and_then(|px| self.sample(picking, *px)));
        samples
    }

    fn sample(&self, picking: &Picking<'_>, px: DVec2) -> Option<Sample> {
        let ray = picking.camera.ray(px, picking.viewport_px);
        let pick = picking.along(ray)?;
        if self.shape == StrokeShape::Curve {
            let point = pick.point;
            return Some(Sample { pick, point, half: 0.0 });
        }
        // A little beyond the entry, so that the next hit is the exit.
        let step = picking.camera.world_per_px(pick.point, picking.viewport_px);
        let origin = pick.point + ray.direction * step;
        let exit = picking.along(Ray { origin, ..ray });
        let half = exit.map_or(0.0, |exit| 0.5 * exit.point.distance(pick.point));
        let point = pick.point + ray.direction * half;
        Some(Sample { pick, point, half })
    }

    /// The curve with its surroundings; `None` if the stroke is too short for one.
    fn drawn(&self, workspace: &Workspace, view: &View) -> Option<Drawn> {
        let picking = workspace.picking(view)?;
        let mut samples = self.samples(&picking);
        let length_px: f64 = self.points_px.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let ends_px = [self.points_px.first()?, self.points_px.last()?];
        let is_closed = self.shape == StrokeShape::Curve
            && length_px >= SHORTEST_CLOSED_PX
            && ends_px[0].distance(*ends_px[1]) <= CLOSING_PX;
        let count = match self.shape {
            StrokeShape::Spine => SPINE_POINTS,
            _ => ((length_px / SPACING_PX) as usize + 1).clamp(*CURVE_POINTS.start(), *CURVE_POINTS.end()),
        };
        let half = level_depths(&mut samples);
        let points = evenly(&samples, count, is_closed);
        let (twist_deg, scale) = (vec![0.0; points.len()], vec![1.0; points.len()]);
        let curve = HandleCurve::new(points.clone(), is_closed, points, twist_deg, scale).ok()?;
        let (vertices, reach) = match self.shape {
            StrokeShape::Spine => (
                around(curve.rest(), GIRTH * half, &samples, &picking),
                SPINE_REACH * half,
            ),
            _ => (
                under(curve.rest(), &samples, &picking),
                CURVE_REACH * curve.rest().length(),
            ),
        };
        (!vertices.is_empty()).then_some(Drawn { curve, vertices, reach })
    }
}

/// Gives samples through gaps and neighbouring limbs the usual half thickness, and returns it.
fn level_depths(samples: &mut [Sample]) -> f64 {
    let mut halves: Vec<f64> = samples.iter().map(|sample| sample.half).collect();
    halves.sort_by(f64::total_cmp);
    let usual = halves.get(halves.len() / 2).copied().unwrap_or(0.0);
    for sample in samples
        .iter_mut()
        .filter(|sample| sample.half > 1.6 * usual || sample.half < 0.4 * usual)
    {
        let inwards = (sample.point - sample.pick.point).normalize_or(-sample.pick.normal);
        sample.point = sample.pick.point + inwards * usual;
        sample.half = usual;
    }
    usual
}

/// Points at even distances along the samples; a closed line does not come to its first point again.
fn evenly(samples: &[Sample], count: usize, is_closed: bool) -> Vec<DVec3> {
    let mut places = vec![0.0];
    for pair in samples.windows(2) {
        places.push(places[places.len() - 1] + pair[0].point.distance(pair[1].point));
    }
    let whole = places[places.len() - 1];
    let steps = if is_closed { count } else { count - 1 } as f64;
    let at = |place: f64| {
        let next = places.partition_point(|other| *other < place).min(samples.len() - 1);
        let before = next.saturating_sub(1);
        let way = places[next] - places[before];
        let share = if way > 0.0 { (place - places[before]) / way } else { 0.0 };
        samples[before].point.lerp(samples[next].point, share)
    };
    match samples {
        [] => Vec::new(),
        _ => (0..count).map(|point| at(whole * point as f64 / steps)).collect(),
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

/// The vertices that are connected with the samples within `limit` of a curve.
fn around(curve: &Curve, limit: f64, samples: &[Sample], picking: &Picking<'_>) -> Vec<SurfaceVertex> {
    const SPANS: usize = 32;
    let at = |span: usize| curve.position(curve.length() * span as f64 / SPANS as f64);
    let line: Vec<DVec3> = (0..=SPANS).map(at).collect();
    let is_near = |vertex: SurfaceVertex| {
        let point = picking.position(vertex);
        line.windows(2).any(|ends| distance_to(point, ends) <= limit)
    };
    let mut found: BTreeSet<SurfaceVertex> = BTreeSet::new();
    let mut stack: Vec<SurfaceVertex> = samples.iter().map(|sample| sample.pick.vertex).collect();
    while let Some(vertex) = stack.pop() {
        if !found.contains(&vertex) && is_near(vertex) {
            found.insert(vertex);
            stack.extend(picking.model.topology.neighbours(vertex));
        }
    }
    found.into_iter().collect()
}

/// The distance of a point from a segment.
fn distance_to(point: DVec3, ends: &[DVec3]) -> f64 {
    let (from, along) = (ends[0], ends[1] - ends[0]);
    let share = (point - from).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
    point.distance(from + along * share.clamp(0.0, 1.0))
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
        // An outline is closed: the way back covers the line that would close it.
        self.points_px
            .iter()
            .chain(self.points_px.iter().rev())
            .copied()
            .collect()
    }

    fn moved(&mut self, _: &mut Context<'_>, pointer: Pointer) -> Next {
        let is_far = |last: &DVec2| last.distance(pointer.position_px) >= STEP_PX;
        if self.points_px.last().is_none_or(is_far) {
            self.points_px.push(pointer.position_px);
        }
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
