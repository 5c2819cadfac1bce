//! Queries: the first triangle on a ray, the vertices in a view, the nearest vertex.

use glam::{DVec3, DVec4};

use super::boxes::{BoxRay, RUN, Span};
use super::{Bvh, Hit};
use crate::SurfaceVertex;
use crate::geometry::distance_to_triangle;

/// Barycentric weights down to this count as inside, so that no ray slips between two triangles.
const EDGE_SLACK: f64 = -1e-9;

impl Bvh {
    /// The first triangle that the ray from `origin` along `direction` (any length) meets, from either side; if several
    /// are at one distance, the lowest.
    pub fn ray(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        self.ray_within(origin, direction, f64::INFINITY)
    }

    /// As [`Bvh::ray`], up to the ray's parameter `limit`. A shorter ray costs less.
    pub fn ray_within(&self, origin: DVec3, direction: DVec3, limit: f64) -> Option<Hit> {
        let ray = BoxRay {
            origin: self.space.of_point(origin),
            inverse: (direction * self.space.scale).recip(),
        };
        let mut best: Option<Hit> = None;
        self.walk(
            |span| ray.entry(span),
            |place| {
                if let Some(hit) = self.meet(place, origin, direction)
                    && hit.distance <= limit
                    && best.is_none_or(|b| (hit.distance, hit.triangle) < (b.distance, b.triangle))
                {
                    best = Some(hit);
                }
                best.map_or(limit, |hit| hit.distance)
            },
        );
        best
    }

    /// Visits, in ascending order, the vertices in the convex space in front of all `planes` (a point p is in front if
    /// its product with (p, 1) is not negative) and some near it, with their positions. Vertices of triangles that the
    /// hierarchy leaves out are included.
    pub fn vertices_within(&self, planes: &[DVec4], mut visit: impl FnMut(SurfaceVertex, DVec3)) {
        // In the boxes' space the same planes have other lengths and distances.
        let planes: Vec<DVec4> = planes
            .iter()
            .map(|plane| {
                let normal = plane.truncate() / self.space.scale;
                normal.extend(plane.w + plane.truncate().dot(self.space.centre))
            })
            .collect();
        let is_apart = |span: &Span| {
            let (min, max) = (span.min.as_dvec3(), span.max.as_dvec3());
            planes.iter().any(|plane| {
                let farthest = DVec3::select(plane.truncate().cmpge(DVec3::ZERO), max, min);
                plane.dot(farthest.extend(1.0)) < 0.0
            })
        };
        for run in (0..self.runs.len()).filter(|&run| !is_apart(&self.runs[run])) {
            for vertex in run * RUN..((run + 1) * RUN).min(self.positions.len()) {
                visit(SurfaceVertex(vertex as u32), self.positions.get(vertex));
            }
        }
    }

    /// The triangle nearest to `point` among those whose first corner `is_meant` and which are not farther than
    /// `limit`: its corner nearest to the point (the lowest if there are several), and the distance to the triangle.
    pub(crate) fn nearest_on_triangles(
        &self,
        point: DVec3,
        limit: f64,
        is_meant: impl Fn(SurfaceVertex) -> bool,
    ) -> Option<(SurfaceVertex, f64)> {
        let in_boxes = self.space.of_point(point);
        let farthest = limit * self.space.scale;
        let mut best: Option<(f64, f64, SurfaceVertex)> = None;
        self.walk(
            |span| {
                Some(span.distance(in_boxes))
                    .filter(|&d| d <= farthest)
                    .unwrap_or(f64::INFINITY)
            },
            |place| {
                let corners = self.leaves.corners[place];
                if is_meant(corners[0]) {
                    let positions = corners.map(|v| self.positions.get(v.index()));
                    let distance = distance_to_triangle(point, positions);
                    if distance <= limit {
                        for (v, position) in corners.into_iter().zip(positions) {
                            let candidate = (distance, position.distance(point), v);
                            if best.is_none_or(|best| candidate < best) {
                                best = Some(candidate);
                            }
                        }
                    }
                }
                best.map_or(f64::INFINITY, |(distance, ..)| distance * self.space.scale)
            },
        );
        best.map(|(distance, _, v)| (v, distance))
    }

    /// The vertex nearest to `point` in a straight line (the lowest if there are several), and its distance; `None` for
    /// an empty hierarchy.
    pub fn nearest_vertex(&self, point: DVec3) -> Option<(SurfaceVertex, f64)> {
        let in_boxes = self.space.of_point(point);
        let mut best: Option<(f64, SurfaceVertex)> = None;
        self.walk(
            |span| span.distance(in_boxes),
            |place| {
                for v in self.leaves.corners[place] {
                    let candidate = (self.positions.get(v.index()).distance(point), v);
                    if best.is_none_or(|best| candidate < best) {
                        best = Some(candidate);
                    }
                }
                best.map_or(f64::INFINITY, |(distance, _)| distance * self.space.scale)
            },
        );
        best.map(|(distance, v)| (v, distance))
    }

    /// The triangle nearest to `point` (the lowest if there are several), and its distance; `None` for an empty
    /// hierarchy.
    pub fn nearest_triangle(&self, point: DVec3) -> Option<(u32, f64)> {
        let in_boxes = self.space.of_point(point);
        let mut best: Option<(f64, u32)> = None;
        self.walk(
            |span| span.distance(in_boxes),
            |place| {
                let corners = self.leaves.corners[place].map(|v| self.positions.get(v.index()));
                let candidate = (distance_to_triangle(point, corners), self.leaves.triangles[place]);
                if best.is_none_or(|best| candidate < best) {
                    best = Some(candidate);
                }
                best.map_or(f64::INFINITY, |(distance, _)| distance * self.space.scale)
            },
        );
        best.map(|(distance, triangle)| (triangle, distance))
    }

    /// The distance from `point` to the nearest triangle that is not farther than `limit` and whose normal is less than a
    /// right angle from `normal`; every triangle counts if that is 0.
    pub fn distance_to_facing(&self, point: DVec3, normal: DVec3, limit: f64) -> Option<f64> {
        let in_boxes = self.space.of_point(point);
        let mut best: Option<f64> = None;
        self.walk(
            |span| span.distance(in_boxes),
            |place| {
                let corners = self.leaves.corners[place].map(|v| self.positions.get(v.index()));
                let [a, b, c] = corners;
                if normal == DVec3::ZERO || (b - a).cross(c - a).dot(normal) > 0.0 {
                    let distance = distance_to_triangle(point, corners);
                    if distance <= best.unwrap_or(limit) {
                        best = Some(distance);
                    }
                }
                best.unwrap_or(limit) * self.space.scale
            },
        );
        best
    }

    /// Visits the triangles' places in every leaf whose box has a `bound` (infinite means never) up to the limit,
    /// nearer boxes first; `visit` returns the new limit.
    fn walk(&self, bound: impl Fn(&Span) -> f64, mut visit: impl FnMut(usize) -> f64) {
        if self.nodes.len() == 0 {
            return;
        }
        let mut limit = f64::INFINITY;
        let mut stack = Vec::with_capacity(64);
        let root = self.nodes.get(0);
        stack.push((bound(&root.span), root.first, root.count));
        while let Some((lower_bound, first, count)) = stack.pop() {
            if lower_bound > limit || lower_bound == f64::INFINITY {
                continue;
            }
            if count > 0 {
                for place in first..first + count {
                    limit = visit(place as usize);
                }
            } else {
                let children = [first, first + 1].map(|child| {
                    let node = self.nodes.get(child as usize);
                    (bound(&node.span), node.first, node.count)
                });
                let [near, far] = if children[0].0 <= children[1].0 {
                    children
                } else {
                    [children[1], children[0]]
                };
                stack.extend([far, near]);
            }
        }
    }

    /// [MT97], both sides.
    fn meet(&self, place: usize, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let [a, b, c] = self.leaves.corners[place].map(|v| self.positions.get(v.index()));
        let (e1, e2) = (b - a, c - a);
        let p = direction.cross(e2);
        let determinant = e1.dot(p);
        if determinant == 0.0 {
            return None;
        }
        let from_a = origin - a;
        let q = from_a.cross(e1);
        let (u, v) = (from_a.dot(p) / determinant, direction.dot(q) / determinant);
        let distance = e2.dot(q) / determinant;
        // Written so that NaN fails.
        if !(u >= EDGE_SLACK && v >= EDGE_SLACK && 1.0 - u - v >= EDGE_SLACK && distance >= 0.0) {
            return None;
        }
        let weights = DVec3::new(1.0 - u - v, u, v).max(DVec3::ZERO);
        let barycentric = (weights / weights.element_sum()).to_array();
        Some(Hit {
            triangle: self.leaves.triangles[place],
            barycentric,
            distance,
        })
    }
}
