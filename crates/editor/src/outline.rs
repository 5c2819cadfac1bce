//! The part of an outline that a sketched line means, and where it goes.
//!
//! The outline consists of the edges between triangles that face the viewer and triangles that face away, and of
//! borders. A line means the way along such edges from the vertex that is nearest to its start to the one nearest to its
//! end: of several ways the one that is near the line and visible. Both are matched by the share of their lengths in the
//! picture, as in \[NSAC05\], so that an outline can be drawn longer than it is.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

use glam::{DVec2, DVec3};
use pliant_mesh::{Bvh, Surface, SurfaceVertex, bounding_box};

use crate::document::HandleSketch;

/// An edge that something hides is this much longer than a visible one.
const HIDDEN: f64 = 10.0;

/// Where the outline is at the line it counts as far from it as this, in normalised device coordinates.
const NEAR: f64 = 0.02;

/// A triangle hides a vertex from this share of the surface's diagonal before it on: those beside an outline graze the
/// ray.
const BEFORE: f64 = 0.01;

/// The outline's vertices from the line's start to its end, each with its way to the line: it keeps its distance from
/// the viewer. Only vertices that are `selected` count. `None` if the line means no outline.
pub(crate) fn matched(
    sketch: &HandleSketch,
    surface: &Surface,
    selected: impl Fn(SurfaceVertex) -> bool,
) -> Option<Vec<(SurfaceVertex, DVec3)>> {
    let seen: Vec<Option<DVec2>> = surface.positions.iter().map(|p| sketch.seen(*p)).collect();
    let graph = Graph::of(&outline_edges(surface, &seen, selected), sketch, surface, &seen);
    let path = graph.path(sketch)?;
    let mut lengths = vec![0.0];
    for pair in path.windows(2) {
        let [a, b] = [pair[0], pair[1]].map(|vertex| seen[vertex as usize].unwrap_or_default());
        lengths.push(lengths[lengths.len() - 1] + a.distance(b));
    }
    let whole = lengths[lengths.len() - 1];
    let way = |(vertex, length): (&u32, &f64)| {
        let rest = surface.positions[*vertex as usize];
        (
            SurfaceVertex(*vertex),
            sketch.put(rest, sketch.point_at(length / whole)) - rest,
        )
    };
    (whole > 0.0).then(|| path.iter().zip(&lengths).map(way).collect())
}

/// The edges between a triangle that faces the viewer and one that faces away, and those of one triangle alone,
/// ascending.
fn outline_edges(surface: &Surface, seen: &[Option<DVec2>], selected: impl Fn(SurfaceVertex) -> bool) -> Vec<[u32; 2]> {
    let mut sides: Vec<([u32; 2], bool)> = Vec::new();
    for corners in &surface.triangles {
        let [Some(a), Some(b), Some(c)] = corners.map(|corner| seen[corner.index()]) else {
            continue;
        };
        let is_front = (b - a).perp_dot(c - a) > 0.0;
        for [from, to] in [[0, 1], [1, 2], [2, 0]].map(|side| side.map(|corner| corners[corner])) {
            if selected(from) && selected(to) {
                sides.push(([from.0.min(to.0), from.0.max(to.0)], is_front));
            }
        }
    }
    sides.sort_unstable();
    let is_outline = |same: &&[([u32; 2], bool)]| same.len() == 1 || same[0].1 != same[same.len() - 1].1;
    sides
        .chunk_by(|a, b| a.0 == b.0)
        .filter(is_outline)
        .map(|same| same[0].0)
        .collect()
}

/// The outline's vertices, joined by its edges.
struct Graph<'a> {
    seen: &'a [Option<DVec2>],
    /// The neighbours of each vertex and the costs of the edges to them.
    around: HashMap<u32, Vec<(u32, f64)>>,
    /// The vertices, ascending.
    vertices: Vec<u32>,
    hidden: HashMap<u32, bool>,
}

impl<'a> Graph<'a> {
    fn of(edges: &[[u32; 2]], sketch: &HandleSketch, surface: &Surface, seen: &'a [Option<DVec2>]) -> Self {
        let mut vertices: Vec<u32> = edges.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let bvh = Bvh::build(&surface.positions, &surface.triangles);
        let place = |vertex: u32| seen[vertex as usize].unwrap_or_default();
        let before = BEFORE * bounding_box(&surface.positions).map_or(0.0, |bounds| bounds.diagonal());
        let is_hidden = |vertex: u32| {
            let position = surface.positions[vertex as usize];
            let towards = sketch.towards_viewer(position);
            bvh.ray(position + towards * before, towards).is_some()
        };
        let hidden: HashMap<u32, bool> = vertices.iter().map(|vertex| (*vertex, is_hidden(*vertex))).collect();
        let mut around: HashMap<u32, Vec<(u32, f64)>> = HashMap::new();
        for [a, b] in edges.iter().copied() {
            let middle = 0.5 * (place(a) + place(b));
            let factor = if hidden[&a] || hidden[&b] { HIDDEN } else { 1.0 };
            let cost = place(a).distance(place(b)) * (NEAR + sketch.distance(middle)) * factor;
            around.entry(a).or_default().push((b, cost));
            around.entry(b).or_default().push((a, cost));
        }
        Self {
            seen,
            around,
            vertices,
            hidden,
        }
    }

    /// The way of least cost between the vertices that are nearest to the line's ends, on the outline where these are
    /// nearest together.
    fn path(&self, sketch: &HandleSketch) -> Option<Vec<u32>> {
        let ends = [sketch.line()[0], sketch.line()[sketch.line().len() - 1]];
        let mut best: Option<(f64, [u32; 2])> = None;
        for part in self.parts() {
            let nearest = ends.map(|end| {
                let each = part.iter().map(|vertex| (self.apart(*vertex, end), *vertex));
                each.fold((f64::INFINITY, 0), |best, own| if own.0 < best.0 { own } else { best })
            });
            let sum = nearest[0].0 + nearest[1].0;
            if best.is_none_or(|best| sum < best.0) {
                best = Some((sum, nearest.map(|own| own.1)));
            }
        }
        let (_, [start, end]) = best?;
        (start != end).then(|| self.shortest(start, end))?
    }

    /// The distance of a vertex from an end of the line; a hidden one is farther.
    fn apart(&self, vertex: u32, end: DVec2) -> f64 {
        let distance = self.seen[vertex as usize].map_or(f64::INFINITY, |place| place.distance(end));
        distance + if self.hidden[&vertex] { NEAR * HIDDEN } else { 0.0 }
    }

    /// The vertices of each connected outline.
    fn parts(&self) -> Vec<Vec<u32>> {
        let mut parts = Vec::new();
        let mut reached: HashMap<u32, ()> = HashMap::new();
        for first in &self.vertices {
            if reached.insert(*first, ()).is_some() {
                continue;
            }
            let mut part = vec![*first];
            let mut next = 0;
            while next < part.len() {
                for (other, _) in &self.around[&part[next]] {
                    if reached.insert(*other, ()).is_none() {
                        part.push(*other);
                    }
                }
                next += 1;
            }
            parts.push(part);
        }
        parts
    }

    /// Dijkstra's path; of equal ones that through lower numbers.
    fn shortest(&self, start: u32, end: u32) -> Option<Vec<u32>> {
        // Costs are not negative, so their bits are in their order.
        let mut queue = BinaryHeap::from([Reverse((0_u64, start, start))]);
        let mut before: HashMap<u32, u32> = HashMap::new();
        while let Some(Reverse((cost, vertex, from))) = queue.pop() {
            if before.contains_key(&vertex) {
                continue;
            }
            before.insert(vertex, from);
            if vertex == end {
                break;
            }
            for (other, more) in &self.around[&vertex] {
                queue.push(Reverse(((f64::from_bits(cost) + more).to_bits(), *other, vertex)));
            }
        }
        let mut path = vec![end];
        while path[path.len() - 1] != start {
            path.push(*before.get(&path[path.len() - 1])?);
        }
        path.reverse();
        Some(path)
    }
}
