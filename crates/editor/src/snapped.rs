//! The curve along the crease or border that another curve means roughly.

use glam::DVec3;
use pliant_mesh::{Bvh, Model, SurfaceVertex, feature_line};

use crate::document::HandleCurve;
use crate::evenly::evenly;

/// The rough curve is laid onto the surface at this share of the distance of the search, at the numbers of places below.
const STEP: f64 = 0.5;
const STEPS: std::ops::RangeInclusive<usize> = 16..=4096;

/// The distance between the found curve's control points, as a share of that of the search, and their possible numbers: so
/// the curve is smoother than the edges along which the line was found.
const SPACING: f64 = 1.5;
const POINTS: std::ops::RangeInclusive<usize> = 3..=64;

/// The curve, at rest and with the same crease, along the crease or border of a surface that lies within `distance` along
/// it from where a rough curve is laid onto it; `None` if there is none ([`feature_line`]).
pub(crate) fn snapped(rough: &HandleCurve, model: &Model, distance: f64) -> Option<HandleCurve> {
    let (surface, curve) = (&model.surface, rough.rest());
    let bvh = Bvh::build(&surface.positions, &surface.triangles);
    let steps = ((curve.length() / (STEP * distance)) as usize).clamp(*STEPS.start(), *STEPS.end());
    let under = |step: usize| -> Option<SurfaceVertex> {
        let point = curve.position(curve.length() * step as f64 / steps as f64);
        let (triangle, _) = bvh.nearest_triangle(point)?;
        let apart = |v: &SurfaceVertex| surface.positions[v.index()].distance_squared(point);
        let corners = surface.triangles[triangle as usize].into_iter();
        corners.min_by(|a, b| apart(a).total_cmp(&apart(b)))
    };
    let mut stroke: Vec<SurfaceVertex> = (0..=steps).filter_map(under).collect();
    stroke.dedup();
    let line = feature_line(surface, &model.topology, &stroke, curve.is_closed(), distance)?;
    let mut places: Vec<DVec3> = line.iter().map(|v| surface.positions[v.index()]).collect();
    let length: f64 = places.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let count = ((length / (SPACING * distance)) as usize + 1).clamp(*POINTS.start(), *POINTS.end());
    if curve.is_closed() {
        places.push(places[0]);
    }
    let points = evenly(&places, count, curve.is_closed());
    let found = HandleCurve::at_rest_through(points, curve.is_closed()).ok()?;
    Some(found.creased(rough.crease()))
}
