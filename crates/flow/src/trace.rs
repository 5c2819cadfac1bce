//! Straight ways across triangles.
//!
//! At an edge the triangle beside is unfolded into the plane, so that the way goes on straight and vectors are carried
//! along it without turning (parallel transport). At a border a way slides along the border.

use glam::DVec2;

use crate::chart::Chart;
use crate::fans::Fans;
use crate::hinges::{Hinges, WALL, last, next};
use crate::plane::{self, conjugate, turned, turned_back};

/// The most ways that are traced at a time.
pub(crate) const BLOCK: usize = 64;

/// A way ends after this many edges. Only a velocity far above an edge a step, or a pile of needles, comes so far.
const MOST_EDGES: usize = 1024;

/// A point on the surface, and the rotation of vectors that were carried to it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub triangle: u32,
    /// Barycentric coordinates: not negative, with the sum 1.
    pub weights: [f64; 3],
    /// From the tangent plane of the vertex at the way's beginning to the triangle's plane.
    pub rotation: DVec2,
}

/// The surface as the flow sees it: triangles in planes of their own, and how planes fit together.
#[derive(Debug)]
pub(crate) struct Domain {
    pub charts: Vec<Chart>,
    pub hinges: Hinges,
    pub fans: Fans,
}

/// A way that has come to a point.
#[derive(Clone, Copy, Default)]
struct Walk {
    triangle: u32,
    weights: [f64; 3],
    /// The rest of the way.
    left: DVec2,
    /// The change of the weights along it.
    rates: [f64; 3],
    rotation: DVec2,
}

impl Walk {
    /// Goes a share of the way that is left.
    #[inline]
    fn advance(&mut self, share: f64) {
        for (weight, rate) in self.weights.iter_mut().zip(self.rates) {
            *weight = (*weight + share * rate).max(0.0);
        }
        self.left *= 1.0 - share;
    }

    /// The point to which it has come.
    #[inline]
    fn end(&self) -> Place {
        let sum: f64 = self.weights.iter().sum();
        Place {
            triangle: self.triangle,
            weights: self.weights.map(|weight| weight / sum),
            rotation: self.rotation,
        }
    }
}

impl Domain {
    /// The ends of the ways from the vertices from `first` on, as many as there are `displacements`, at most [`BLOCK`],
    /// each a vector in the tangent plane of its vertex; `None` for a bare vertex.
    ///
    /// One thing after another for all of them, so that the processor works at several ways at a time: each thing waits
    /// for the one before, for memory or for a root.
    pub fn trace(&self, first: usize, displacements: &[DVec2], places: &mut [Option<Place>; BLOCK]) {
        let count = displacements.len().min(BLOCK);
        let mut angles = [0.0; BLOCK];
        for (angle, &displacement) in angles.iter_mut().zip(displacements) {
            *angle = plane::angle(displacement);
        }
        let mut sectors = [0; BLOCK];
        for (i, (sector, &angle)) in sectors.iter_mut().zip(&angles).enumerate().take(count) {
            *sector = self.fans.sector(first + i, angle);
        }
        let mut walks = [None; BLOCK];
        for (i, walk) in walks.iter_mut().enumerate().take(count) {
            *walk = self.begin(first + i, (displacements[i], angles[i], sectors[i]));
        }
        for (place, walk) in places.iter_mut().zip(walks).take(count) {
            *place = walk.map(|walk| self.walk(walk));
        }
    }

    /// The beginning of the way from a vertex along a displacement, at an angle and in a sector of its fan.
    #[inline]
    fn begin(&self, vertex: usize, (displacement, angle, sector): (DVec2, f64, usize)) -> Option<Walk> {
        let own = *self.fans.corners(vertex).first()?;
        let way = match displacement == DVec2::ZERO {
            true => None,
            false => self
                .fans
                .way(vertex, (displacement, angle, sector), &self.hinges, &self.charts),
        };
        let (corner, left) = way.map_or((own, DVec2::ZERO), |way| (way.corner, way.direction));
        let k = corner as usize % 3;
        let mut weights = [0.0; 3];
        weights[k] = 1.0;
        let rates = self.charts[corner as usize / 3].rates(left);
        let [after, before] = [(k + 1) % 3, (k + 2) % 3].map(|other| rates[other].max(0.0));
        Some(Walk {
            triangle: corner / 3,
            weights,
            left,
            rates,
            rotation: conjugate(self.fans.rotation_along(corner, after, before)),
        })
    }

    /// Walks to the end.
    fn walk(&self, mut walk: Walk) -> Place {
        // The edge through which the triangle was entered: rounding must not lead back through it.
        let mut entered = None;
        for _ in 0..MOST_EDGES {
            let Some((k, share)) = exit(walk.weights, walk.rates, entered) else {
                walk.advance(1.0);
                break;
            };
            walk.advance(share);
            walk.weights[k] = 0.0;
            let edge = 3 * walk.triangle + k as u32;
            entered = match self.hinges.beside(edge) {
                WALL => self.slide(&mut walk, edge),
                other => Some(self.cross(&mut walk, edge, other)),
            };
        }
        walk.end()
    }

    /// Goes over from the triangle of `edge` to that of `other`; returns the edge's number there.
    #[inline]
    fn cross(&self, walk: &mut Walk, edge: u32, other: u32) -> usize {
        let turn = self.turn(edge, other);
        let (k, m) = (edge as usize % 3, other as usize % 3);
        let mut weights = [0.0; 3];
        weights[(m + 1) % 3] = walk.weights[(k + 2) % 3];
        weights[(m + 2) % 3] = walk.weights[(k + 1) % 3];
        walk.triangle = other / 3;
        walk.weights = weights;
        walk.left = turned(turn, walk.left);
        walk.rates = self.charts[other as usize / 3].rates(walk.left);
        walk.rotation = turned(turn, walk.rotation);
        m
    }

    /// The rotation from the plane of the triangle of `edge` to that of `other`, the same edge beside.
    #[inline]
    pub fn turn(&self, edge: u32, other: u32) -> DVec2 {
        let vector = |edge: u32| self.charts[edge as usize / 3].edge(edge as usize % 3);
        // Both have the same length.
        let (from, to) = (vector(edge), -vector(other));
        turned_back(from, to) / from.length_squared()
    }

    /// Follows the border, on which the walk stands at `edge`. Where the border turns, the way turns with it.
    fn slide(&self, walk: &mut Walk, mut edge: u32) -> Option<usize> {
        let along = self.charts[edge as usize / 3].edge(edge as usize % 3);
        let is_forward = walk.left.dot(along) > 0.0;
        let mut left = walk.left.dot(along).abs() / along.length();
        (walk.left, walk.rates) = (DVec2::ZERO, [0.0; 3]);
        for _ in 0..MOST_EDGES {
            let length = self.charts[edge as usize / 3].edge(edge as usize % 3).length();
            // The walk stands on the edge between `from`, which it leaves, and `to`.
            let ends = [next(edge) as usize % 3, last(edge) as usize % 3];
            let [from, to] = if is_forward { ends } else { [ends[1], ends[0]] };
            let way = walk.weights[from] * length;
            if left <= way {
                let share = left / length;
                walk.weights[from] -= share;
                walk.weights[to] += share;
                return None;
            }
            left -= way;
            walk.weights = [0.0; 3];
            walk.weights[to] = 1.0;
            edge = self.around(walk, 3 * walk.triangle + to as u32, is_forward);
        }
        None
    }

    /// Carries a walk that stands on the vertex of `corner` around it to the border's other edge, and returns that.
    fn around(&self, walk: &mut Walk, mut corner: u32, is_forward: bool) -> u32 {
        for _ in 0..MOST_EDGES {
            // Forward the border comes counterclockwise along an edge and leaves at the fan's clockwise end.
            let crossed = if is_forward { last(corner) } else { next(corner) };
            let other = self.hinges.beside(crossed);
            if other == WALL {
                return crossed;
            }
            self.cross(walk, crossed, other);
            corner = if is_forward { last(other) } else { next(other) };
            walk.weights = [0.0; 3];
            walk.weights[corner as usize % 3] = 1.0;
        }
        corner
    }

    /// The value of a vector field, given in the vertices' tangent planes, at a place, carried back to the tangent
    /// plane of the vertex from which the place was reached.
    #[inline]
    pub fn vector_at(&self, place: &Place, vertices: [usize; 3], field: &[DVec2]) -> DVec2 {
        let mut sum = DVec2::ZERO;
        for k in 0..3 {
            let [after, before] = [(k + 1) % 3, (k + 2) % 3].map(|other| place.weights[other]);
            let rotation = self.fans.rotation_along(3 * place.triangle + k as u32, after, before);
            sum += turned_back(rotation, field[vertices[k]]) * place.weights[k];
        }
        turned_back(place.rotation, sum)
    }
}

/// The edge through which a point leaves a triangle before its barycentric coordinates have changed by `rates`, and the
/// share of the way to it.
#[inline]
fn exit(weights: [f64; 3], rates: [f64; 3], entered: Option<usize>) -> Option<(usize, f64)> {
    let mut found = None;
    let mut least = 1.0;
    for k in 0..3 {
        if Some(k) != entered && weights[k] + rates[k] < 0.0 {
            let share = weights[k] / -rates[k];
            if share < least {
                (found, least) = (Some(k), share);
            }
        }
    }
    found.map(|k| (k, least))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use std::f64::consts::{PI, TAU};

    use glam::DVec3;
    use pliant_mesh::{Model, shapes};

    use super::*;

    fn domain(model: &Model) -> Domain {
        let (surface, topology) = (&model.surface, &model.topology);
        let charts: Vec<Chart> = (0..surface.triangles.len())
            .map(|t| Chart::of(surface.corners(t)))
            .collect();
        let hinges = Hinges::of(surface, topology);
        let fans = Fans::of(surface, topology, &hinges, &charts);
        Domain { charts, hinges, fans }
    }

    fn traced(domain: &Domain, vertex: usize, displacement: DVec2) -> Option<Place> {
        let mut places = [None; BLOCK];
        domain.trace(vertex, &[displacement], &mut places);
        places[0]
    }

    fn place_of(domain: &Domain, vertex: usize, displacement: DVec2) -> Place {
        traced(domain, vertex, displacement).unwrap()
    }

    fn position(model: &Model, place: &Place) -> DVec3 {
        let corners = model.surface.corners(place.triangle as usize);
        (0..3).map(|k| corners[k] * place.weights[k]).sum()
    }

    #[test]
    fn on_a_flat_sheet_ways_are_straight_lines_and_end_at_its_border() {
        let model = shapes::model(shapes::grid(9, 7));
        let domain = domain(&model);
        for (v, &from) in model.surface.positions.iter().enumerate() {
            // The tangent planes' axes in space: from the way along each.
            let step = 1e-3;
            let towards = |direction: DVec2| (position(&model, &place_of(&domain, v, direction * step)) - from) / step;
            for turn in 0..16 {
                let direction = DVec2::from_angle(TAU * f64::from(turn) / 16.0 + 0.1);
                let short = towards(direction);
                if (short.length() - 1.0).abs() > 1e-9 {
                    continue; // along the border
                }
                let end = position(&model, &place_of(&domain, v, direction * 0.3));
                let straight = from + short * 0.3;
                if straight.x.min(straight.y) > 0.0 && straight.x.max(straight.y) < 1.0 {
                    assert!(end.distance(straight) < 1e-9, "{v}: {end} {straight}");
                }
                assert!(end.x.min(end.y) > -1e-12 && end.x.max(end.y) < 1.0 + 1e-12);
            }
        }
    }

    #[test]
    fn on_a_sphere_a_way_of_a_full_turn_comes_home() {
        let model = shapes::model(shapes::icosphere(4));
        let domain = domain(&model);
        for v in (0..model.surface.positions.len()).step_by(97) {
            let place = place_of(&domain, v, DVec2::from_angle(v as f64) * TAU);
            let from = model.surface.positions[v];
            assert!(position(&model, &place).distance(from) < 0.05);
            let half = place_of(&domain, v, DVec2::from_angle(v as f64) * PI);
            assert!(position(&model, &half).distance(-from) < 0.05);
        }
    }

    #[test]
    fn a_way_along_a_border_goes_around_all_of_it() {
        let model = shapes::model(shapes::grid(5, 5));
        let domain = domain(&model);
        let corner = model.surface.positions.iter().position(|p| *p == DVec3::ZERO).unwrap();
        let first = domain.fans.corners(corner)[0];
        for (length, end) in [
            (0.5, DVec3::new(0.5, 0.0, 0.0)),
            (1.5, DVec3::new(1.0, 0.5, 0.0)),
            (4.0, DVec3::ZERO),
        ] {
            let edge = last(first);
            let along = domain.charts[edge as usize / 3].edge(edge as usize % 3).normalize();
            let mut walk = Walk {
                triangle: first / 3,
                left: along * length,
                ..Walk::default()
            };
            walk.weights[first as usize % 3] = 1.0;
            domain.slide(&mut walk, edge);
            let place = walk.end();
            assert!(position(&model, &place).distance(end) < 1e-9, "{length}");
        }
    }

    #[test]
    fn ways_end_on_every_class_of_surface_even_if_they_are_long() {
        for (name, drawn) in shapes::classes() {
            let model = shapes::model(drawn);
            let domain = domain(&model);
            for v in 0..model.surface.positions.len() {
                for length in [1e-9, 0.1, 30.0] {
                    if let Some(place) = traced(&domain, v, DVec2::from_angle(v as f64) * length) {
                        let sum: f64 = place.weights.iter().sum();
                        assert!(
                            (sum - 1.0).abs() < 1e-12 && place.weights.iter().all(|w| *w >= 0.0),
                            "{name}"
                        );
                        assert!((place.rotation.length() - 1.0).abs() < 1e-9, "{name}");
                    }
                }
            }
        }
    }
}
