//! The way of a plane over a surface, from triangle to triangle.
//!
//! Vertices in the plane count as in front of it, so that the way crosses edges and never a vertex.

use glam::DVec3;
use pliant_mesh::{Model, SurfaceVertex};

/// A crossing keeps this share of its edge from both ends.
pub(super) const INSIDE: f64 = 1e-6;

/// A point on an edge of the surface.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Crossing {
    /// Ascending.
    pub(super) ends: [SurfaceVertex; 2],
    /// The share of the edge before it.
    pub(super) share: f64,
}

/// The plane of the points p with `normal` · (p − `through`) = 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    pub(super) normal: DVec3,
    pub(super) through: DVec3,
}

/// The end of a way.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Goal {
    /// This triangle.
    Triangle(u32),
    /// A border, not farther than this length.
    Border(f64),
}

/// A way: its crossings, the triangle after each of them except the border's, and its length.
#[derive(Clone, Debug, Default)]
pub(super) struct Way {
    pub(super) crossings: Vec<Crossing>,
    pub(super) triangles: Vec<u32>,
    pub(super) length: f64,
}

impl Section {
    fn is_front(&self, model: &Model, vertex: SurfaceVertex) -> bool {
        self.height(model, vertex) >= 0.0
    }

    fn height(&self, model: &Model, vertex: SurfaceVertex) -> f64 {
        let position = model.surface.positions[vertex.index()];
        self.normal.dot(position - self.through)
    }

    /// Its crossing with an edge between its two sides.
    fn crossing(&self, model: &Model, ends: [SurfaceVertex; 2]) -> Crossing {
        let ends = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        let [from, to] = ends.map(|end| self.height(model, end));
        let share = (from / (from - to)).clamp(INSIDE, 1.0 - INSIDE);
        Crossing { ends, share }
    }

    /// The edges of a triangle that it crosses: none or two.
    fn crossed(&self, model: &Model, triangle: u32) -> Vec<[SurfaceVertex; 2]> {
        let [a, b, c] = model.surface.triangles[triangle as usize];
        let is_crossed = |ends: &[SurfaceVertex; 2]| self.is_front(model, ends[0]) != self.is_front(model, ends[1]);
        [[a, b], [b, c], [c, a]].into_iter().filter(is_crossed).collect()
    }

    /// The shorter of the ways from a point inside a triangle to a goal; `None` if neither comes there. A way to a
    /// border leaves in `direction`.
    pub(super) fn way(&self, model: &Model, from: (u32, DVec3), direction: DVec3, goal: Goal) -> Option<Way> {
        let (triangle, point) = from;
        let mut exits = self.crossed(model, triangle);
        let forwards = |ends: &[SurfaceVertex; 2]| {
            let crossing = self.crossing(model, *ends);
            (crossing.position(model) - point).dot(direction)
        };
        exits.sort_by(|a, b| forwards(b).total_cmp(&forwards(a)));
        let most = match goal {
            Goal::Triangle(_) => 2,
            Goal::Border(_) => 1,
        };
        let mut best: Option<Way> = None;
        for exit in exits.into_iter().take(most) {
            let longest = best.as_ref().map_or(f64::INFINITY, |best| best.length);
            let found = self.follow(model, (triangle, point), exit, goal, longest);
            best = found.or(best);
        }
        best
    }

    /// The way that leaves a triangle by an edge; `None` if it does not come to its goal within `longest`.
    fn follow(
        &self,
        model: &Model,
        (mut triangle, mut point): (u32, DVec3),
        mut exit: [SurfaceVertex; 2],
        goal: Goal,
        longest: f64,
    ) -> Option<Way> {
        let longest = match goal {
            Goal::Triangle(_) => longest,
            Goal::Border(limit) => longest.min(limit),
        };
        let triangles = &model.surface.triangles;
        let mut way = Way::default();
        for _ in 0..triangles.len() {
            let crossing = self.crossing(model, exit);
            let next = crossing.position(model);
            way.length += point.distance(next);
            if way.length >= longest {
                return None;
            }
            point = next;
            way.crossings.push(crossing);
            let around = model.topology.faces(exit[0], triangles);
            let mut beyond = around.filter(|&t| t != triangle && triangles[t as usize].contains(&exit[1]));
            let Some(neighbour) = beyond.next() else {
                return matches!(goal, Goal::Border(_)).then_some(way);
            };
            if beyond.next().is_some() {
                return None;
            }
            way.triangles.push(neighbour);
            if goal == Goal::Triangle(neighbour) {
                return Some(way);
            }
            let is_other = |ends: &[SurfaceVertex; 2]| !(ends.contains(&exit[0]) && ends.contains(&exit[1]));
            exit = self.crossed(model, neighbour).into_iter().find(is_other)?;
            triangle = neighbour;
        }
        None
    }
}

impl Crossing {
    /// Its position.
    pub(super) fn position(&self, model: &Model) -> DVec3 {
        let [from, to] = self.ends.map(|end| model.surface.positions[end.index()]);
        from.lerp(to, self.share)
    }
}
