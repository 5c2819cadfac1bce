//! The common border: the points of both borders in one order, and their targets.
//!
//! Two points of both borders become one if they are nearest to each other, and nearer than a third of the edges there.
//! Every other point cuts the other border's edge.

use glam::DVec3;

use super::choice::Join;
use super::line::Line;

/// Points nearer than this share of the shorter edge there become one.
const ONE: f64 = 0.34;

/// A point of the common border.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Node {
    /// Its place on A's border and on B's.
    pub on: [Place; 2],
    /// The way along A's border.
    pub way: f64,
    /// Its target.
    pub target: DVec3,
}

/// A place on a line.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Place {
    /// A vertex of the line, by its place.
    Vertex(usize),
    /// A point inside an edge (with the number of its first vertex), and the share of the edge before it.
    Edge(usize, f64),
}

impl Place {
    /// The point of a line.
    pub fn point(self, line: &Line) -> DVec3 {
        match self {
            Self::Vertex(k) => line.points[k],
            Self::Edge(k, share) => line.points[k].lerp(line.points[(k + 1) % line.count()], share),
        }
    }
}

/// The common border of two lines; both are in their final places. Points closer than `touch` keep A's place.
pub(crate) fn seam(join: &Join, touch: f64) -> Vec<Node> {
    let (a, b) = (&join.a, &join.b);
    let length = a.length();
    let ways: Vec<f64> = (0..b.count())
        .map(|j| join.map.other(1, b.ways[j]).rem_euclid(length))
        .collect();
    let mates = mates(a, b, &ways);
    let mut mate_of_b = vec![None; b.count()];
    for (i, mate) in mates.iter().enumerate() {
        if let Some(j) = mate {
            mate_of_b[*j] = Some(i);
        }
    }
    // Each entry: the way, and the vertices of A and of B.
    let mut order: Vec<(f64, Option<usize>, Option<usize>)> = mates
        .iter()
        .enumerate()
        .map(|(i, &mate)| (a.ways[i], Some(i), mate))
        .collect();
    order.extend(
        (0..b.count())
            .filter(|&j| mate_of_b[j].is_none())
            .map(|j| (ways[j], None, Some(j))),
    );
    order.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)).then(x.2.cmp(&y.2)));
    let places_a = places(a, &order.iter().map(|(way, i, _)| (*i, *way)).collect::<Vec<_>>());
    let on_b = |way: f64, j: Option<usize>| (j, join.map.other(0, way));
    let places_b = places(b, &order.iter().map(|&(way, _, j)| on_b(way, j)).collect::<Vec<_>>());
    let nodes = order.iter().zip(places_a.into_iter().zip(places_b));
    nodes
        .map(|(&(way, ..), (on_a, on_b))| {
            let (from_a, from_b) = (on_a.point(a), on_b.point(b));
            let target = if from_a.distance(from_b) <= touch {
                from_a
            } else {
                from_a.midpoint(from_b)
            };
            Node {
                on: [on_a, on_b],
                way,
                target,
            }
        })
        .collect()
}

/// For each vertex of A the vertex of B that becomes one with it.
fn mates(a: &Line, b: &Line, ways: &[f64]) -> Vec<Option<usize>> {
    let length = a.length();
    let mut sorted: Vec<(f64, usize)> = ways.iter().copied().zip(0..).collect();
    sorted.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
    let of_a: Vec<(f64, usize)> = a.ways[..a.count()].iter().copied().zip(0..).collect();
    let off = |x: f64, y: f64| {
        let ahead = (x - y).rem_euclid(length);
        ahead.min(length - ahead)
    };
    let nearest = |list: &[(f64, usize)], way: f64| {
        let next = list.partition_point(|(own, _)| *own < way);
        let around = [(next + list.len() - 1) % list.len(), next % list.len()];
        let best = around.map(|k| (off(list[k].0, way), list[k].1));
        if best[0].0 <= best[1].0 { best[0] } else { best[1] }
    };
    (0..a.count())
        .map(|i| {
            let (far, j) = nearest(&sorted, a.ways[i]);
            let (_, back) = nearest(&of_a, ways[j]);
            let edge = a.shorter_edge(i).min(b.shorter_edge(j) * length / b.length());
            (back == i && far <= ONE * edge).then_some(j)
        })
        .collect()
}

/// The places of entries on a line, in cyclic order: vertices, and points on edges by their ways.
fn places(line: &Line, entries: &[(Option<usize>, f64)]) -> Vec<Place> {
    let count = entries.len();
    let Some(first) = entries.iter().position(|(vertex, _)| vertex.is_some()) else {
        return Vec::new();
    };
    let mut places = vec![Place::Vertex(0); count];
    let mut step = 0;
    while step < count {
        let at = (first + step) % count;
        let vertex = entries[at].0.unwrap_or(0);
        places[at] = Place::Vertex(vertex);
        let mut inside = 0;
        while step + inside + 1 < count && entries[(at + inside + 1) % count].0.is_none() {
            inside += 1;
        }
        let edge = line.ways[vertex + 1] - line.ways[vertex];
        let share = |k: usize| {
            let ahead = (entries[(at + k) % count].1 - line.ways[vertex]).rem_euclid(line.length());
            if edge > 0.0 { ahead / edge } else { 2.0 }
        };
        let mut shares: Vec<f64> = (1..=inside).map(share).collect();
        let is_rising = shares.iter().all(|share| *share > 0.0 && *share < 1.0) && shares.is_sorted_by(|x, y| x < y);
        if !is_rising {
            // Rounding, or a mate beyond, left no rising order: the points are spread evenly.
            shares = (1..=inside).map(|k| k as f64 / (inside + 1) as f64).collect();
        }
        for (k, share) in shares.into_iter().enumerate() {
            places[(at + k + 1) % count] = Place::Edge(vertex, share);
        }
        step += inside + 1;
    }
    places
}
