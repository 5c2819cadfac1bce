//! Cutting along a plane: triangles that it crosses are split, so that the border lies on it.
//!
//! A surface's vertices are sorted by their distance from the plane. Every edge between two sides gets one point, found
//! from the surface's edge alone, so that the triangles on both sides of it agree to the bit and no crack opens. Drawn
//! vertices on a seam get their own, with their own numbers.

use std::collections::BTreeMap;

use glam::DVec3;
use pliant_mesh::{DrawnVertex, SurfaceVertex};

use crate::error::StitchError;
use crate::part::Part;
use crate::pieces::{Corner, CutPoint, Pieces};
use crate::shape::{Age, NewShape, TriangleSource};

/// A plane in world space.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Plane {
    /// A unit vector. The positive side is the one to which it points.
    normal: DVec3,
    /// The signed distance from the origin, in world units.
    offset: f64,
}

/// The sides of a plane that are kept.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Keep {
    /// The side to which the normal points.
    #[default]
    Positive,
    /// The other side.
    Negative,
    /// Both: triangles are split, and nothing is deleted.
    Both,
}

/// Vertices closer to the plane than this share of the surface's size lie on it.
const TOUCH: f64 = 1e-9;

impl Plane {
    /// The plane of the points p with `normal` · p = `level`; `None` if the normal has no direction, or for numbers that
    /// are not finite.
    pub fn of(normal: DVec3, level: f64) -> Option<Self> {
        let length = normal.length();
        let plane = Self {
            normal: normal.try_normalize()?,
            offset: level / length,
        };
        (length.is_finite() && plane.offset.is_finite()).then_some(plane)
    }

    /// The signed distance of a point, in world units.
    pub fn distance(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }
}

impl NewShape {
    /// Cuts a part along a plane. Vertices that are left keep their order and come before new ones. A triangle in the
    /// plane belongs to the positive side. `spared` has a flag for each surface vertex that stays, with whole connected
    /// parts, wherever the plane is; a missing one is false.
    ///
    /// # Errors
    /// [`StitchError::PlaneMisses`] if the plane has everything else on one side.
    pub fn cut_along(part: &Part<'_>, plane: &Plane, keep: Keep, spared: &[bool]) -> Result<Self, StitchError> {
        let mut cutting = Cutting::of(part, plane, keep, spared)?;
        for (triangle, corners) in (0..).zip(&part.drawn.triangles) {
            if !part.is_broken(corners) {
                cutting.add(triangle, *corners);
            }
        }
        Ok(cutting.finished())
    }
}

struct Cutting<'a> {
    part: &'a Part<'a>,
    keep: Keep,
    /// The distance of each surface vertex from the plane: 0 on it. A spared one counts as far on a kept side.
    distances: Vec<f64>,
    pieces: Pieces,
    point_of: BTreeMap<[DrawnVertex; 2], u32>,
    edges: BTreeMap<[SurfaceVertex; 2], u32>,
}

impl<'a> Cutting<'a> {
    fn of(part: &'a Part<'a>, plane: &Plane, keep: Keep, spared: &[bool]) -> Result<Self, StitchError> {
        let positions = &part.model.surface.positions;
        let diagonal = part.model.bounds().map_or(0.0, |bounds| bounds.diagonal());
        let touch = TOUCH * diagonal;
        let is_spared = |vertex: usize| spared.get(vertex) == Some(&true);
        let distance = |(vertex, &position): (usize, &DVec3)| match (is_spared(vertex), keep) {
            (true, Keep::Negative) => -diagonal,
            (true, Keep::Positive | Keep::Both) => diagonal,
            (false, _) => {
                let distance = plane.distance(position);
                if distance.abs() <= touch { 0.0 } else { distance }
            }
        };
        let distances: Vec<f64> = positions.iter().enumerate().map(distance).collect();
        let used = part.model.surface.triangles.iter().flatten();
        let used = used.filter(|vertex| !is_spared(vertex.index()));
        let (low, high) = used.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), vertex| {
            let own = distances[vertex.index()];
            (low.min(own), high.max(own))
        });
        // In the caller's measure of the plane's level.
        if low >= 0.0 || high <= 0.0 {
            return Err(StitchError::PlaneMisses {
                from: low + plane.offset,
                to: high + plane.offset,
            });
        }
        Ok(Self {
            part,
            keep,
            distances,
            pieces: Pieces::default(),
            point_of: BTreeMap::new(),
            edges: BTreeMap::new(),
        })
    }

    /// The surface's vertex and the distance of a drawn vertex.
    fn at(&self, vertex: DrawnVertex) -> Option<(SurfaceVertex, f64)> {
        let surface = self.part.model.drawn.surface_vertex(vertex)?;
        Some((surface, self.distances[surface.index()]))
    }

    fn distance(&self, vertex: DrawnVertex) -> f64 {
        self.at(vertex).map_or(0.0, |(_, distance)| distance)
    }

    fn keeps(&self, is_positive: bool) -> bool {
        match self.keep {
            Keep::Positive => is_positive,
            Keep::Negative => !is_positive,
            Keep::Both => true,
        }
    }

    /// Adds a triangle, or its pieces on the kept sides.
    fn add(&mut self, triangle: u32, corners: [DrawnVertex; 3]) {
        let distances = corners.map(|corner| self.distance(corner));
        let source = |age| TriangleSource { part: 0, triangle, age };
        let has = |is_side: fn(f64) -> bool| distances.iter().any(|&distance| is_side(distance));
        let (is_below, is_above) = (has(|distance| distance < 0.0), has(|distance| distance > 0.0));
        if !(is_below && is_above) {
            if self.keeps(!is_below) {
                self.pieces.triangles.push((corners.map(Corner::Old), source(Age::Old)));
            }
            return;
        }
        // The outline of each side, in the triangle's direction; corners on the plane belong to both.
        let mut sides: [Vec<Corner>; 2] = Default::default();
        for k in 0..3 {
            let (own, next) = (corners[k], corners[(k + 1) % 3]);
            let (here, there) = (distances[k], distances[(k + 1) % 3]);
            for (side, is_in) in [here >= 0.0, here <= 0.0].into_iter().enumerate() {
                sides[side].extend(is_in.then_some(Corner::Old(own)));
            }
            if (here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0) {
                let point = Corner::New(self.point(own, next));
                sides.iter_mut().for_each(|side| side.push(point));
            }
        }
        for (outline, is_positive) in sides.iter().zip([true, false]) {
            if self.keeps(is_positive) {
                for piece in self.triangles(outline) {
                    self.pieces.triangles.push((piece, source(Age::New)));
                }
            }
        }
    }

    /// The point at which the edge between two drawn vertices crosses the plane.
    fn point(&mut self, a: DrawnVertex, b: DrawnVertex) -> u32 {
        let (Some((of_a, _)), Some((of_b, _))) = (self.at(a), self.at(b)) else {
            return 0;
        };
        let ends = if of_a < of_b { [a, b] } else { [b, a] };
        if let Some(&known) = self.point_of.get(&ends) {
            return known;
        }
        let on_surface = [of_a.min(of_b), of_a.max(of_b)];
        let [from, to] = on_surface.map(|vertex| self.distances[vertex.index()]);
        let share = from / (from - to);
        let positions = &self.part.model.surface.positions;
        let count = self.edges.len() as u32;
        let edge = *self.edges.entry(on_surface).or_insert(count);
        self.pieces.surface_points = self.edges.len();
        self.pieces.points.push(CutPoint {
            corners: [ends[0], ends[1], ends[1]],
            shares: [share, 0.0],
            position: positions[on_surface[0].index()].lerp(positions[on_surface[1].index()], share),
            on_surface: edge,
        });
        let number = self.pieces.points.len() as u32 - 1;
        self.point_of.insert(ends, number);
        number
    }

    fn position(&self, corner: Corner) -> DVec3 {
        match corner {
            Corner::Old(vertex) => self.part.drawn.positions[vertex.index()],
            Corner::New(point) => self.pieces.points[point as usize].position,
        }
    }

    /// The triangles of an outline of three or four corners: four are cut along the shorter diagonal.
    fn triangles(&self, outline: &[Corner]) -> Vec<[Corner; 3]> {
        match *outline {
            [a, b, c] => vec![[a, b, c]],
            [a, b, c, d] => {
                let length = |from, to| self.position(from).distance_squared(self.position(to));
                match length(a, c) <= length(b, d) {
                    true => vec![[a, b, c], [a, c, d]],
                    false => vec![[b, c, d], [b, d, a]],
                }
            }
            _ => Vec::new(),
        }
    }

    /// The shape of all pieces. Vertices that no triangle used stay on the kept side.
    fn finished(self) -> NewShape {
        let is_kept = |vertex| self.keeps(self.distance(vertex) >= 0.0);
        self.pieces.shape(self.part, is_kept)
    }
}
