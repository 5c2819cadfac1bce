//! The crease or border that a rough line along the surface means.
//!
//! A crease is where the surface bends sharply across and hardly along, so each edge near the line is as good as the
//! smoothed normals turn across it: the normal curvature across the edge, at the scale of the search, times a closeness
//! that falls a little from 1 at the line to the search's width. An edge of a border is as good as it is close. The line is then
//! the way of least cost over the edges, as with intelligent scissors [MB95]: along a crease a length costs a hundredth of
//! what it costs beside it. Ridges and valleys, which bend in opposite directions, and borders are searched one after the
//! other, and the cheapest line counts.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{DMat2, DMat3, DVec2, DVec3};

use crate::geometry::SomeVertices;
use crate::{DistanceSearch, Surface, SurfaceVertex, Topology};

/// The normals are smoothed over this share of the width.
const SCALE: f64 = 0.25;

/// The closeness falls by this share from the line to the search's width.
const FALL: f64 = 0.3;

/// The cost of a length along the sharpest crease; beside all creases it is 1 more.
const LEAST_COST: f64 = 0.01;

/// The cost of a length from an end of the line to the crease.
const JUMP_COST: f64 = 0.3;

/// Across the width the surface turns by this angle in radians, or there is no crease.
const LEAST_TURN_RAD: f64 = 0.05;

/// The vertices, in order, along the crease or border near a line over the surface: `stroke` has the vertices along it,
/// and vertices up to `width` from it along the surface count. A closed line returns from its last vertex to its first
/// one. `None` if the surface is flat there and has no border, or if the line is shorter than an edge.
pub fn feature_line(
    surface: &Surface,
    topology: &Topology,
    stroke: &[SurfaceVertex],
    is_closed: bool,
    width: f64,
) -> Option<Vec<SurfaceVertex>> {
    let strip = |stroke: &[SurfaceVertex]| Reached::of(surface, topology, stroke, width);
    if !is_closed {
        return Strip::of(surface, topology, &strip(stroke)).line(&free_ends(surface, stroke, width));
    }
    // Two halves: each one alone would lead back on the way on which it came.
    let (first, rest) = stroke.split_at(stroke.len() / 2);
    let there = Strip::of(surface, topology, &strip(first)).line(&free_ends(surface, first, width))?;
    let (start, end) = (*there.first()?, *there.last()?);
    let back: Vec<SurfaceVertex> = [&[end], rest, &[start]].concat();
    let ends = [end, start].map(|v| vec![(v, 0.0)]);
    let mut back = Strip::of(surface, topology, &strip(&back)).line(&ends)?;
    back.pop();
    Some([&there[..there.len() - 1], &back].concat())
}

/// The vertices at which a line may begin and end, each with the cost of the way to it.
type Ends = [Vec<(SurfaceVertex, f64)>; 2];

fn free_ends(surface: &Surface, stroke: &[SurfaceVertex], width: f64) -> Ends {
    let near = |end: Option<&SurfaceVertex>| {
        let Some(end) = end else { return Vec::new() };
        let place = surface.positions[end.index()];
        let all = surface.positions.iter().enumerate();
        let near = all.filter_map(|(v, p)| {
            let distance = p.distance(place);
            (distance <= width).then_some((SurfaceVertex(v as u32), JUMP_COST * distance))
        });
        near.collect()
    };
    [near(stroke.first()), near(stroke.last())]
}

/// The vertices near a stroke, ascending, with their closeness.
struct Reached {
    vertices: Vec<SurfaceVertex>,
    closeness: Vec<f64>,
    width: f64,
}

impl Reached {
    fn of(surface: &Surface, topology: &Topology, stroke: &[SurfaceVertex], width: f64) -> Self {
        let seeds: Vec<(SurfaceVertex, f64)> = stroke.iter().map(|&v| (v, 0.0)).collect();
        let position = |v: SurfaceVertex| surface.positions[v.index()];
        let mut search = DistanceSearch::default();
        let reached = search.within(&surface.triangles, topology, position, &seeds, width);
        let mut reached = reached.to_vec();
        reached.sort_unstable_by_key(|(v, _)| *v);
        Self {
            vertices: reached.iter().map(|(v, _)| *v).collect(),
            closeness: reached.iter().map(|(_, d)| 1.0 - FALL * (d / width).powi(2)).collect(),
            width,
        }
    }
}

/// The surface near a stroke.
struct Strip<'a> {
    reached: &'a Reached,
    some: SomeVertices<'a>,
    normals: Vec<DVec3>,
    /// The change of the normal on a way across it, in radians per length: positive where the surface is convex.
    bends: Vec<DMat3>,
    /// The edges of one triangle alone, ascending.
    rims: Vec<[SurfaceVertex; 2]>,
}

impl<'a> Strip<'a> {
    fn of(surface: &'a Surface, topology: &'a Topology, reached: &'a Reached) -> Self {
        let some = SomeVertices::of(topology, &surface.positions, &reached.vertices);
        let normals = some.normals(&surface.triangles, SCALE * reached.width);
        let bends = some.each(|place| bend(&some, &normals, place));
        let near = |v: &SurfaceVertex| some.place(*v).is_some();
        let rims = topology
            .boundary_edge_list()
            .iter()
            .filter(|edge| edge.iter().all(near));
        let mut rims: Vec<[SurfaceVertex; 2]> = rims.map(|[a, b]| [*a.min(b), *a.max(b)]).collect();
        rims.sort_unstable();
        Self {
            reached,
            some,
            normals,
            bends,
            rims,
        }
    }

    /// The line of least cost between the ends along a ridge, a valley or a border.
    fn line(&self, ends: &Ends) -> Option<Vec<SurfaceVertex>> {
        let places = 0..self.reached.vertices.len();
        let bends = places.flat_map(|a| self.some.neighbours(a).map(move |b| self.bend_across(a, b).abs()));
        let sharpest = bends.fold(0.0, f64::max);
        let mut lines = Vec::new();
        if sharpest * self.reached.width >= LEAST_TURN_RAD {
            let along = |share: f64| self.shortest(ends, |a, b| self.bend_across(a, b) * share);
            lines.extend([along(1.0 / sharpest), along(-1.0 / sharpest)]);
        }
        if !self.rims.is_empty() {
            lines.push(self.shortest(ends, |a, b| self.rim_closeness(a, b)));
        }
        let least = |best: Option<(f64, Vec<SurfaceVertex>)>, own: (f64, Vec<SurfaceVertex>)| match best {
            Some(best) if best.0 <= own.0 => Some(best),
            _ => Some(own),
        };
        let (_, line) = lines.into_iter().flatten().fold(None, least)?;
        (line.len() > 1).then_some(line)
    }

    /// The mean bend across an edge times the closeness.
    fn bend_across(&self, a: usize, b: usize) -> f64 {
        let along = self.some.position(b) - self.some.position(a);
        let at = |place: usize| {
            let across = self.normals[place].cross(along).normalize_or_zero();
            across.dot(self.bends[place] * across) * self.reached.closeness[place]
        };
        0.5 * (at(a) + at(b))
    }

    /// The closeness of an edge of the border, 0 for others.
    fn rim_closeness(&self, a: usize, b: usize) -> f64 {
        let edge = [a.min(b), a.max(b)].map(|place| self.reached.vertices[place]);
        match self.rims.binary_search(&edge) {
            Ok(_) => 0.5 * (self.reached.closeness[a] + self.reached.closeness[b]),
            Err(_) => 0.0,
        }
    }

    /// Dijkstra's path from one of the first ends to one of the last ones, with its cost: `good` is 1 for the best edges
    /// and 0 or less for the worst. Of equal paths it is the one through lower numbers.
    fn shortest(
        &self,
        [firsts, lasts]: &Ends,
        good: impl Fn(usize, usize) -> f64,
    ) -> Option<(f64, Vec<SurfaceVertex>)> {
        let count = self.reached.vertices.len();
        let cost = |a: usize, b: usize| {
            let bad = 1.0 - good(a, b).clamp(0.0, 1.0).powi(2);
            self.some.position(a).distance(self.some.position(b)) * (LEAST_COST + bad * bad)
        };
        let places = |ends: &[(SurfaceVertex, f64)]| {
            let near = ends.iter().filter_map(|(v, cost)| Some((self.some.place(*v)?, *cost)));
            near.collect::<Vec<_>>()
        };
        let mut to_end = vec![f64::INFINITY; count];
        for (place, cost) in places(lasts) {
            to_end[place as usize] = cost;
        }
        // Costs are not negative, so their bits are in their order.
        let begin = places(firsts)
            .into_iter()
            .map(|(v, cost)| Reverse((cost.to_bits(), v, v)));
        let mut queue: BinaryHeap<Reverse<(u64, u32, u32)>> = begin.collect();
        let mut before = vec![u32::MAX; count];
        let mut best: Option<(f64, u32)> = None;
        while let Some(Reverse((so_far, place, from))) = queue.pop() {
            let so_far = f64::from_bits(so_far);
            if best.is_some_and(|(least, _)| least <= so_far) {
                break;
            }
            let here = place as usize;
            if before[here] != u32::MAX {
                continue;
            }
            before[here] = from;
            let whole = so_far + to_end[here];
            if whole.is_finite() && best.is_none_or(|(least, _)| whole < least) {
                best = Some((whole, place));
            }
            for next in self.some.neighbours(here).filter(|next| before[*next] == u32::MAX) {
                queue.push(Reverse(((so_far + cost(here, next)).to_bits(), next as u32, place)));
            }
        }
        let (whole, mut place) = best?;
        let mut path = vec![self.reached.vertices[place as usize]];
        while before[place as usize] != place {
            place = before[place as usize];
            path.push(self.reached.vertices[place as usize]);
        }
        path.reverse();
        Some((whole, path))
    }
}

/// The symmetric map S across the normal with S e nearest to the change of the normal along each edge e, each edge
/// counting by the angle.
fn bend(some: &SomeVertices<'_>, normals: &[DVec3], place: usize) -> DMat3 {
    let normal = normals[place];
    let Some(first) = normal.try_normalize().map(DVec3::any_orthonormal_vector) else {
        return DMat3::ZERO;
    };
    let axes = [first, normal.cross(first)];
    let flat = |v: DVec3| DVec2::new(v.dot(axes[0]), v.dot(axes[1]));
    let outer = |a: DVec2, b: DVec2| DMat2::from_cols(a * b.x, a * b.y);
    let (mut turns, mut ways) = (DMat2::ZERO, DMat2::ZERO);
    for other in some.neighbours(place) {
        let way = flat(some.position(other) - some.position(place));
        let square = way.length_squared();
        if square > 0.0 {
            turns += outer(flat(normals[other] - normal), way) * (1.0 / square);
            ways += outer(way, way) * (1.0 / square);
        }
    }
    let solved = turns * ways.inverse();
    if !solved.is_finite() {
        return DMat3::ZERO;
    }
    let bend = (solved + solved.transpose()) * 0.5;
    let wide = |a: usize, b: usize| {
        let [p, q] = [axes[a], axes[b]];
        DMat3::from_cols(p * q.x, p * q.y, p * q.z) * bend.col(b)[a]
    };
    wide(0, 0) + wide(0, 1) + wide(1, 0) + wide(1, 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Model, shapes};

    /// The vertices nearest to places along a line.
    fn stroke(model: &Model, points: impl Iterator<Item = DVec3>) -> Vec<SurfaceVertex> {
        let positions = &model.surface.positions;
        let nearest = points.map(|point| {
            let each = (0..positions.len()).min_by(|&a, &b| {
                let apart = |v: usize| positions[v].distance_squared(point);
                apart(a).total_cmp(&apart(b))
            });
            SurfaceVertex(each.unwrap_or_default() as u32)
        });
        nearest.collect()
    }

    fn found(model: &Model, stroke: &[SurfaceVertex], is_closed: bool, width: f64) -> Option<Vec<DVec3>> {
        let line = feature_line(&model.surface, &model.topology, stroke, is_closed, width)?;
        Some(line.iter().map(|v| model.surface.positions[v.index()]).collect())
    }

    /// A cube of 24 cells a side whose edges and corners are round.
    fn round_cube(radius: f64) -> Model {
        let mut drawn = shapes::bar(24, 24, 24);
        for p in &mut drawn.positions {
            let inner = p.clamp(DVec3::splat(radius), DVec3::splat(24.0 - radius));
            *p = inner + radius * (*p - inner).normalize();
        }
        shapes::model(drawn)
    }

    #[test]
    fn a_line_beside_a_rounded_edge_of_a_cube_runs_along_it_within_an_edges_length() {
        for radius in [0.5, 2.0] {
            let model = round_cube(radius);
            // Three cells beside the edge along x, on the top.
            let rough = (5..=19).map(|x| DVec3::new(f64::from(x), 3.0 + 0.4 * f64::from(x % 3), 24.0));
            let line = found(&model, &stroke(&model, rough), false, 5.0).unwrap_or_default();
            let [first, last] = [line[0].x, line[line.len() - 1].x];
            assert!(
                (first - 5.0).abs() <= 1.0 && (last - 19.0).abs() <= 1.0,
                "{first} {last}"
            );
            let middle = radius * (1.0 - 0.5_f64.sqrt());
            for p in &line {
                let off = DVec2::new(p.y - middle, 24.0 - middle - p.z).length();
                assert!(off <= 1.0, "{radius}: {p}");
            }
        }
    }

    #[test]
    fn a_border_is_found_exactly_open_and_all_around() {
        let model = shapes::model(shapes::tube(40, 30, 6.0));
        let top = model.surface.positions.iter().map(|p| p.z).fold(f64::MIN, f64::max);
        let around = |turns: f64| {
            (0..=30).map(move |i| {
                let (sin, cos) = (turns * f64::from(i) / 30.0 * std::f64::consts::TAU).sin_cos();
                DVec3::new(cos, sin, top - 0.5)
            })
        };
        for (turns, is_closed, least) in [(0.5, false, 19), (0.97, true, 40)] {
            let line = found(&model, &stroke(&model, around(turns)), is_closed, 0.9).unwrap_or_default();
            assert!(line.iter().all(|p| p.z == top), "{line:?}");
            assert!((least..=least + 4).contains(&line.len()), "{}", line.len());
        }
    }

    #[test]
    fn a_valley_is_found_beside_a_ridge_that_is_farther_and_a_flat_sheet_has_neither() {
        let mut drawn = shapes::grid(60, 20);
        for p in &mut drawn.positions {
            // A valley at 0.4, a ridge at 0.6.
            let x = 60.0 * (p.x - 0.5);
            p.z = match x {
                x if x < -6.0 => -0.3 - 0.05 * (x + 6.0),
                x if x > 6.0 => 0.3 - 0.05 * (x - 6.0),
                x => 0.05 * x,
            };
            *p = DVec3::new(x, 20.0 * p.y, 4.0 * p.z);
        }
        let model = shapes::model(drawn);
        for (beside, at) in [(-4.0, -6.0), (-8.0, -6.0), (4.5, 6.0)] {
            let rough = (3..=17).map(|y| DVec3::new(beside, f64::from(y), 0.0));
            let line = found(&model, &stroke(&model, rough), false, 4.0).unwrap_or_default();
            assert!(
                line.len() > 10 && line.iter().all(|p| (p.x - at).abs() < 1e-9),
                "{beside}: {line:?}"
            );
        }
        let flat = shapes::model(shapes::grid(20, 20));
        let rough = (5..=15).map(|y| DVec3::new(0.5, f64::from(y) / 20.0, 0.0));
        assert_eq!(found(&flat, &stroke(&flat, rough), false, 0.2), None);
    }

    #[test]
    fn the_line_does_not_depend_on_the_number_of_threads() {
        let model = round_cube(2.0);
        let rough = stroke(&model, (5..=19).map(|x| DVec3::new(f64::from(x), 3.0, 24.0)));
        let lines = [1, 2, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let pool = pool.unwrap_or_else(|error| unreachable!("{error}"));
            pool.install(|| found(&model, &rough, false, 5.0))
        });
        assert!(lines[0].is_some() && lines[0] == lines[1] && lines[1] == lines[2]);
    }
}
