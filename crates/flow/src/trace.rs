//! Straight ways across triangles.
//!
//! At an edge the triangle beside is unfolded into the plane, so that the way goes straight on and vectors are carried
//! along it without turning (parallel transport). A way is given by the barycentric coordinates of its end and by their
//! change along it: both go linearly from one triangle's plane to the next one's, so a crossing takes no division and
//! reads one line of memory. At a border a way slides along the border (`slide`).

use glam::DVec2;

use crate::domain::{Domain, MOST_EDGES, Place};
use crate::hinges::WALL;
use crate::plane::{self, conjugate, turned, turned_back};
use crate::slide::OnBorder;

/// The most ways that are traced at a time.
pub(crate) const BLOCK: usize = 64;

/// The beginning of a way.
#[derive(Clone, Copy, Debug)]
struct Start {
    /// The corner of the triangle that it enters.
    corner: u32,
    /// The way in the plane of the triangle.
    way: DVec2,
    /// From the tangent plane of its vertex to the triangle's plane.
    rotation: DVec2,
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
        let mut starts = [None; BLOCK];
        for (i, start) in starts.iter_mut().enumerate().take(count) {
            *start = self.start(first + i, (displacements[i], angles[i], sectors[i]));
        }
        for (place, start) in places.iter_mut().zip(starts).take(count) {
            *place = start.map(|start| self.walk(start));
        }
    }

    /// The beginning of the way from a vertex along a displacement, at an angle and in a sector of its fan.
    #[inline]
    fn start(&self, vertex: usize, (displacement, angle, sector): (DVec2, f64, usize)) -> Option<Start> {
        let own = *self.fans.corners(vertex).first()?;
        let way = match displacement == DVec2::ZERO {
            true => None,
            false => self
                .fans
                .way(vertex, (displacement, angle, sector), &self.crossings, &self.charts),
        };
        let (corner, way) = way.map_or((own, DVec2::ZERO), |way| (way.corner, way.direction));
        let k = corner as usize % 3;
        let rates = self.charts[corner as usize / 3].rates(way);
        let [after, before] = [(k + 1) % 3, (k + 2) % 3].map(|other| rates[other].max(0.0));
        Some(Start {
            corner,
            way,
            rotation: conjugate(self.fans.rotation_along(corner, after, before)),
        })
    }

    /// Walks to the end.
    #[inline]
    fn walk(&self, start: Start) -> Place {
        const LAST: [usize; 3] = [2, 0, 1];
        const NEXT: [usize; 3] = [1, 2, 0];
        let mut triangle = start.corner / 3;
        let rates = self.charts[triangle as usize].rates(start.way);
        // The coordinate of the corner opposite the edge through which the triangle was entered, and those of the next
        // and the last corner: at the way's end, and its change along the way.
        let mut m = start.corner as usize % 3;
        let mut far = DVec2::new(1.0 + rates[m], rates[m]);
        let mut after = DVec2::splat(rates[NEXT[m]]);
        let mut before = DVec2::splat(rates[LAST[m]]);
        // A way that begins at a corner leaves by the edge opposite.
        let (mut k, mut out, mut kept) = (m, far, [after, before]);
        let mut crossed = 0;
        while out.x < 0.0 {
            let (other, [to_next, to_last, across]) = self.crossings.across(triangle, k);
            if other == WALL || crossed == MOST_EDGES {
                let share = if out.y < 0.0 { out.x / out.y } else { 0.0 };
                let mut weights = [0.0; 3];
                weights[NEXT[k]] = (kept[0].x - share * kept[0].y).max(0.0);
                weights[LAST[k]] = (kept[1].x - share * kept[1].y).max(0.0);
                let way = self.way_there(triangle, m, [far, after, before]);
                let rotation = turn(&start, way);
                if other != WALL {
                    return Place::at(triangle, weights, rotation);
                }
                let edge = 3 * triangle + k as u32;
                let sum = weights.iter().sum::<f64>();
                let weights = weights.map(|weight| weight / sum);
                return self.slide(
                    OnBorder {
                        edge,
                        weights,
                        rotation,
                    },
                    way * share,
                );
            }
            crossed += 1;
            (triangle, m) = (other / 3, other as usize % 3);
            // The edge's ends change their roles.
            before = kept[0] + out * to_next;
            after = kept[1] + out * to_last;
            far = out * across;
            // The side of the opposite corner on which the way passes.
            let is_first = after.x < 0.0 && (before.x >= 0.0 || after.perp_dot(before) >= 0.0);
            (k, out, kept) = if is_first {
                (NEXT[m], after, [before, far])
            } else {
                (LAST[m], before, [far, after])
            };
        }
        let mut weights = [0.0; 3];
        (weights[m], weights[NEXT[m]], weights[LAST[m]]) = (far.x, after.x, before.x);
        let rotation = match crossed {
            0 => start.rotation,
            _ => turn(&start, self.way_there(triangle, m, [far, after, before])),
        };
        Place::at(triangle, weights, rotation)
    }

    /// A whole way in the plane of a triangle, from the changes of the coordinates of corner `m`, the next and the last.
    #[inline]
    fn way_there(&self, triangle: u32, m: usize, [far, after, before]: [DVec2; 3]) -> DVec2 {
        let mut rates = [0.0; 3];
        (rates[m], rates[(m + 1) % 3], rates[(m + 2) % 3]) = (far.y, after.y, before.y);
        self.charts[triangle as usize].along(rates)
    }
}

/// The rotation from the tangent plane in which a way begins to that in which it is `way`.
#[inline]
fn turn(start: &Start, way: DVec2) -> DVec2 {
    turned(turned_back(start.way, way).normalize_or(DVec2::X), start.rotation)
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
