//! The track of a curve on a surface: points in triangles and on edges, each in one triangle with the next.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use pliant_mesh::{Bvh, Model, SurfaceVertex};

use super::line::{Sight, SurfaceCurve};
use super::walk::{Crossing, Goal, INSIDE, Section, Way};
use crate::error::StitchError;

/// An end of an open curve goes on to a border that is within this share of the surface's diagonal.
const TO_BORDER: f64 = 0.01;

/// A place of a track.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Station {
    /// Inside a triangle, by the weights of its corners.
    Inside { triangle: u32, weights: DVec3 },
    /// On an edge.
    On(Crossing),
}

/// A curve on a surface.
#[derive(Clone, Debug, Default)]
pub(super) struct Track {
    /// In order. Those of a closed curve begin on an edge, if any is on one.
    pub(super) stations: Vec<Station>,
    /// The triangle between each station and the next; of a closed curve, also after the last.
    pub(super) triangles: Vec<u32>,
}

impl Station {
    pub(super) fn position(&self, model: &Model) -> DVec3 {
        match self {
            Self::Inside { triangle, weights } => at(model, *triangle, *weights),
            Self::On(crossing) => crossing.position(model),
        }
    }
}

fn at(model: &Model, triangle: u32, weights: DVec3) -> DVec3 {
    let [a, b, c] = model.surface.corners(triangle as usize);
    a * weights.x + b * weights.y + c * weights.z
}

/// A point of the curve, inside a triangle.
#[derive(Clone, Copy)]
struct Placed {
    triangle: u32,
    weights: DVec3,
    position: DVec3,
    /// The triangle's normal, as long as twice its area.
    normal: DVec3,
}

impl Track {
    /// The track of a curve. Parts with `spared` vertices are left alone.
    ///
    /// # Errors
    /// Too few points, points on several parts, an end inside the surface, and points between which the surface has no way.
    pub(super) fn of(model: &Model, curve: &SurfaceCurve, spared: &[bool]) -> Result<Self, StitchError> {
        let (found, least) = (curve.points.len(), if curve.is_closed { 3 } else { 2 });
        if found < least {
            return Err(StitchError::CurveTooShort { found, least });
        }
        let placed = placed(model, curve, spared)?;
        let part = |point: usize| {
            let [corner, ..] = model.surface.triangles[placed[point].triangle as usize];
            model.topology.component(corner)
        };
        if let Some([from, _]) = curve.segments().find(|[from, to]| part(*from) != part(*to)) {
            return Err(StitchError::CurveChangesPart { from });
        }
        let mut track = Self::default();
        if !curve.is_closed {
            let mut way = to_border(model, curve, [placed[0], placed[1]], 0)?;
            way.crossings.reverse();
            way.triangles.reverse();
            track.stations.extend(way.crossings.into_iter().map(Station::On));
            track.triangles.extend(way.triangles);
            track.triangles.push(placed[0].triangle);
        }
        for [from, to] in curve.segments() {
            let (start, end) = (placed[from], placed[to]);
            track.push(start);
            track.triangles.push(start.triangle);
            if start.triangle != end.triangle {
                let way = between(model, curve, [start, end]);
                let way = way.ok_or(StitchError::CurveLost { from })?;
                track.stations.extend(way.crossings.into_iter().map(Station::On));
                track.triangles.extend(way.triangles);
            }
        }
        if curve.is_closed {
            track.begin_on_an_edge();
        } else {
            let last = placed.len() - 1;
            let way = to_border(model, curve, [placed[last], placed[last - 1]], last)?;
            track.push(placed[last]);
            track.triangles.push(placed[last].triangle);
            track.stations.extend(way.crossings.into_iter().map(Station::On));
            track.triangles.extend(way.triangles);
        }
        Ok(track)
    }

    fn push(&mut self, placed: Placed) {
        let Placed { triangle, weights, .. } = placed;
        self.stations.push(Station::Inside { triangle, weights });
    }

    fn begin_on_an_edge(&mut self) {
        let first = self
            .stations
            .iter()
            .position(|station| matches!(station, Station::On(_)));
        if let Some(first) = first {
            self.stations.rotate_left(first);
            self.triangles.rotate_left(first);
        }
    }
}

/// The points of a curve on the nearest triangles that have an area.
fn placed(model: &Model, curve: &SurfaceCurve, spared: &[bool]) -> Result<Vec<Placed>, StitchError> {
    let is_offered = |&triangle: &u32| {
        let corners: [SurfaceVertex; 3] = model.surface.triangles[triangle as usize];
        let is_spared = |v: &SurfaceVertex| spared.get(v.index()) == Some(&true);
        !corners.iter().any(is_spared) && normal(model, triangle) != DVec3::ZERO
    };
    let offered: Vec<u32> = (0..model.surface.triangles.len() as u32).filter(is_offered).collect();
    let triangles: Vec<_> = offered.iter().map(|&t| model.surface.triangles[t as usize]).collect();
    let bvh = Bvh::build(&model.surface.positions, &triangles);
    let place = |(number, &point): (usize, &DVec3)| {
        let (nearest, _) = bvh
            .nearest_triangle(point)
            .ok_or(StitchError::CurveLost { from: number })?;
        let triangle = offered[nearest as usize];
        let weights = inside(model, triangle, point);
        Ok(Placed {
            triangle,
            weights,
            position: at(model, triangle, weights),
            normal: normal(model, triangle),
        })
    };
    curve.points.iter().enumerate().map(place).collect()
}

fn normal(model: &Model, triangle: u32) -> DVec3 {
    let [a, b, c] = model.surface.corners(triangle as usize);
    (b - a).cross(c - a)
}

/// The weights of a point that is put onto a triangle, well inside it.
fn inside(model: &Model, triangle: u32, point: DVec3) -> DVec3 {
    let [a, b, c] = model.surface.corners(triangle as usize);
    let normal = (b - a).cross(c - a);
    let share = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(normal) / normal.length_squared();
    let weights = DVec3::new(share(b, c), share(c, a), share(a, b)).max(DVec3::splat(INSIDE));
    weights / weights.element_sum()
}

/// The direction of sight at a segment, of length 1.
fn sight(curve: &SurfaceCurve, [start, end]: [Placed; 2]) -> DVec3 {
    let direction = match curve.sight {
        Sight::Normals => start.normal.normalize_or_zero() + end.normal.normalize_or_zero(),
        Sight::From(eye) => start.position - eye,
        Sight::Along(direction) => direction,
    };
    direction.try_normalize().unwrap_or(start.normal.normalize_or_zero())
}

/// The plane through a segment and the direction of sight, and the segment's direction in its picture.
fn section(curve: &SurfaceCurve, [start, end]: [Placed; 2]) -> (Section, DVec3) {
    let (along, sight) = (end.position - start.position, sight(curve, [start, end]));
    let section = Section {
        normal: along.cross(sight).normalize_or_zero(),
        through: start.position,
    };
    (section, along - sight * sight.dot(along))
}

/// The number of planes through two points that are tried, evenly turned, if that along the sight leads nowhere: it may
/// meet the surface at both points in loops of their own.
const PLANES: u32 = 12;

/// The way from a point of a curve to the next.
fn between(model: &Model, curve: &SurfaceCurve, ends: [Placed; 2]) -> Option<Way> {
    let [start, end] = ends;
    let (from, goal) = ((start.triangle, start.position), Goal::Triangle(end.triangle));
    let (section, direction) = section(curve, ends);
    section.way(model, from, direction, goal).or_else(|| {
        let along = end.position - start.position;
        let axis = along.try_normalize()?;
        let turned = (1..PLANES).map(|step| Section {
            normal: DQuat::from_axis_angle(axis, PI * f64::from(step) / f64::from(PLANES)) * section.normal,
            ..section
        });
        let ways = turned.filter_map(|section| section.way(model, from, along, goal));
        ways.min_by(|a, b| a.length.total_cmp(&b.length))
    })
}

/// The way from an end of a curve to a border, on from its last segment.
fn to_border(
    model: &Model,
    curve: &SurfaceCurve,
    [end, before]: [Placed; 2],
    point: usize,
) -> Result<Way, StitchError> {
    let diagonal = model.bounds().map_or(0.0, |bounds| bounds.diagonal());
    let (section, back) = section(curve, [end, before]);
    let goal = Goal::Border(TO_BORDER * diagonal);
    let way = section.way(model, (end.triangle, end.position), -back, goal);
    way.ok_or(StitchError::CurveEndsInside { point })
}
