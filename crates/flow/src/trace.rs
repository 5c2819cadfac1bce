//! Straight ways across triangles.
//!
//! At an edge the triangle beside is unfolded into the plane, so that the way goes straight on and vectors are carried
//! along it without turning (parallel transport). A way is given by the barycentric coordinates of its end and by their
//! change along it: both go linearly from one triangle's plane to the next one's, so a crossing takes no division and
//! reads one line of memory. At a border a way slides along the border (`slide`).
//!
//! Many ways are traced at a time, one thing after another for all of them: arithmetic goes in the processor's vectors,
//! and it waits for several places of memory at once.

use glam::DVec2;

use crate::domain::{Domain, MOST_EDGES, Place};
use crate::hinges::WALL;
use crate::lanes::{LANES, Lanes, Vectors, change, put, vector};
use crate::plane::{turned, turned_back};
use crate::slide::OnBorder;
use crate::starts::Starts;

const NEXT: [usize; 3] = [1, 2, 0];
const LAST: [usize; 3] = [2, 0, 1];

/// The ends of ways.
pub(crate) struct Ends {
    pub triangles: [u32; LANES],
    /// Barycentric coordinates: not negative, with the sum 1; all zero for a bare vertex.
    pub weights: [Lanes; 3],
    /// From the tangent planes of the vertices at the ways' beginnings to the triangles' planes.
    pub rotations: Vectors,
}

impl Ends {
    pub fn new() -> Self {
        Self {
            triangles: [0; LANES],
            weights: [[0.0; LANES]; 3],
            rotations: [[1.0; LANES], [0.0; LANES]],
        }
    }

    /// Whether a way began at a bare vertex, and has no end.
    #[inline(always)]
    pub fn is_bare(&self, i: usize) -> bool {
        self.weights.iter().all(|weights| weights[i] == 0.0)
    }
}

/// A way that has come into a triangle.
#[derive(Clone, Copy)]
struct Walk {
    triangle: u32,
    /// The corner opposite the edge through which the triangle was entered, or that at which the way begins.
    corner: usize,
    /// The coordinates of that corner, the next and the last one: at the way's end, and their changes along the way.
    coordinates: [DVec2; 3],
    has_crossed: bool,
}

/// Why a walk ended.
enum End {
    Inside(Walk),
    /// At the edge of this number in its triangle.
    AtEdge(Walk, usize),
}

impl Domain {
    /// The ends of the ways from the vertices from `first` on, `count` of them, along displacements in the tangent
    /// planes of these vertices. Further displacements must be numbers.
    #[inline(always)]
    pub fn trace(&self, first: usize, count: usize, displacements: &Vectors, ends: &mut Ends) {
        let starts = Starts::of(self, first, count, displacements);
        let mut arrived: [Lanes; 3] = [[0.0; LANES]; 3];
        let mut there: Vectors = starts.ways;
        // Ways that slid along a border are finished already.
        let (mut slid, mut slid_count) = ([None; LANES], 0);
        for i in 0..count {
            ends.triangles[i] = 0;
            if starts.corners[i] == WALL {
                continue;
            }
            match self.walk(starts.corners[i], [0, 1, 2].map(|k| starts.rates[k][i])) {
                End::Inside(walk) => {
                    ends.triangles[i] = walk.triangle;
                    for (k, coordinate) in [walk.corner, NEXT[walk.corner], LAST[walk.corner]]
                        .into_iter()
                        .zip(walk.coordinates)
                    {
                        arrived[k][i] = coordinate.x;
                    }
                    if walk.has_crossed {
                        put(&mut there, i, self.way_there(&walk));
                    }
                }
                End::AtEdge(walk, k) => {
                    let start = (vector(&starts.ways, i), vector(&starts.rotations, i));
                    slid[slid_count] = Some((i, self.at_edge(&walk, k, start)));
                    slid_count += 1;
                }
            }
        }
        change(&mut there, |i, there| {
            let turn = turned_back(vector(&starts.ways, i), there);
            let length = turn.length();
            let turn = if length > 0.0 { turn / length } else { DVec2::X };
            turned(turn, vector(&starts.rotations, i))
        });
        ends.rotations = there;
        for i in 0..LANES {
            let inside = [0, 1, 2].map(|k| if arrived[k][i] > 0.0 { arrived[k][i] } else { 0.0 });
            let sum = inside[0] + inside[1] + inside[2];
            let inverse = if sum > 0.0 { 1.0 / sum } else { 0.0 };
            for k in 0..3 {
                ends.weights[k][i] = inside[k] * inverse;
            }
        }
        for (i, place) in slid.into_iter().take(slid_count).flatten() {
            ends.triangles[i] = place.triangle;
            for (weights, weight) in ends.weights.iter_mut().zip(place.weights) {
                weights[i] = weight;
            }
            put(&mut ends.rotations, i, place.rotation);
        }
    }

    /// Walks to the end of a way that begins at a corner.
    #[inline(always)]
    fn walk(&self, corner: u32, rates: [f64; 3]) -> End {
        let [far, after, before] = rates;
        let mut walk = Walk {
            triangle: corner / 3,
            corner: corner as usize % 3,
            coordinates: [DVec2::new(1.0 + far, far), DVec2::splat(after), DVec2::splat(before)],
            has_crossed: false,
        };
        // A way that begins at a corner leaves by the edge opposite.
        let (mut k, [mut out, mut next, mut last]) = (walk.corner, walk.coordinates);
        let mut crossed = 0;
        while out.x < 0.0 {
            let (other, [to_next, to_last, across]) = self.crossings.across(walk.triangle, k);
            if other == WALL || crossed == MOST_EDGES {
                return End::AtEdge(walk, k);
            }
            crossed += 1;
            let m = other as usize % 3;
            // The edge's ends change their roles.
            let [far, after, before] = [out * across, last + out * to_last, next + out * to_next];
            walk = Walk {
                triangle: other / 3,
                corner: m,
                coordinates: [far, after, before],
                has_crossed: true,
            };
            // The side of the opposite corner on which the way passes.
            let is_first = after.x < 0.0 && (before.x >= 0.0 || after.perp_dot(before) >= 0.0);
            (k, out, next, last) = match is_first {
                true => (NEXT[m], after, before, far),
                false => (LAST[m], before, far, after),
            };
        }
        End::Inside(walk)
    }

    /// The whole way of a walk in the plane of its triangle.
    #[inline(always)]
    fn way_there(&self, walk: &Walk) -> DVec2 {
        let mut rates = [0.0; 3];
        let corners = [walk.corner, NEXT[walk.corner], LAST[walk.corner]];
        for (corner, coordinate) in corners.into_iter().zip(walk.coordinates) {
            rates[corner] = coordinate.y;
        }
        self.charts[walk.triangle as usize].along(rates)
    }

    /// The end of a walk that can't cross edge `k`: it slides along a border, and stops where too many edges were
    /// crossed. `start` has the way and the rotation at its beginning.
    #[inline(never)]
    fn at_edge(&self, walk: &Walk, k: usize, (way, rotation): (DVec2, DVec2)) -> Place {
        let mut coordinates = [DVec2::ZERO; 3];
        let corners = [walk.corner, NEXT[walk.corner], LAST[walk.corner]];
        for (corner, coordinate) in corners.into_iter().zip(walk.coordinates) {
            coordinates[corner] = coordinate;
        }
        let out = coordinates[k];
        let left = if out.y < 0.0 { (out.x / out.y).min(1.0) } else { 0.0 };
        let mut weights = coordinates.map(|coordinate| coordinate.x - left * coordinate.y);
        weights[k] = 0.0;
        let way_there = self.way_there(walk);
        let rotation = turned(turned_back(way, way_there).normalize_or(DVec2::X), rotation);
        let place = Place::at(walk.triangle, weights, rotation);
        let edge = 3 * walk.triangle + k as u32;
        match self.crossings.beside(edge) {
            WALL => self.slide(OnBorder::at(place, edge), way_there * left),
            _ => place,
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use std::f64::consts::{PI, TAU};

    use glam::DVec3;
    use pliant_mesh::{Model, shapes};

    use super::*;
    use crate::chart::Chart;
    use crate::crossings::Crossings;
    use crate::fans::Fans;
    use crate::hinges::{Hinges, last};

    fn domain(model: &Model) -> Domain {
        let (surface, topology) = (&model.surface, &model.topology);
        let charts: Vec<Chart> = (0..surface.triangles.len())
            .map(|t| Chart::of(surface.corners(t)))
            .collect();
        let hinges = Hinges::of(surface, topology);
        Domain {
            fans: Fans::of(surface, topology, &hinges, &charts),
            crossings: Crossings::of(&hinges, &charts),
            charts,
        }
    }

    fn traced(domain: &Domain, vertex: usize, displacement: DVec2) -> Option<Place> {
        let (mut ends, mut displacements) = (Ends::new(), [[0.0; LANES]; 2]);
        put(&mut displacements, 0, displacement);
        domain.trace(vertex, 1, &displacements, &mut ends);
        let is_bare = domain.fans.corners(vertex).is_empty();
        (!is_bare).then(|| Place {
            triangle: ends.triangles[0],
            weights: [0, 1, 2].map(|k| ends.weights[k][0]),
            rotation: vector(&ends.rotations, 0),
        })
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
            let mut weights = [0.0; 3];
            weights[first as usize % 3] = 1.0;
            let rotation = DVec2::X;
            let place = domain.slide(
                OnBorder {
                    edge,
                    weights,
                    rotation,
                },
                along * length,
            );
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
