//! A bounding-volume hierarchy over a surface's triangles: rays, nearest vertices and views, refitted while it moves.
//!
//! obvhs builds the tree (PLOC, Meister and Bittner 2018); walking it is done here, because its own traversal works in
//! f32 throughout. Boxes are f32, relative to a centre and scaled to the unit cube, and rounded outward; positions and
//! all tests on them are f64. So a surface at geographic coordinates is hit as exactly as one at the origin.
//!
//! Boxes and positions lie in [`Blocks`]: a copy is nearly free, and refitting it writes anew what moved alone, so that
//! one is refitted while the other still answers.

use std::sync::Arc;

use glam::{DVec3, DVec4, Vec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use rayon::prelude::*;

use crate::blocks::{BLOCK, Blocks};
use crate::surface::corners;
use crate::triangle_distance::distance_to_triangle;
use crate::{SurfaceVertex, bounding_box};

/// Where a ray met the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The triangle, as an index into those that the hierarchy was built over.
    pub triangle: u32,
    /// The weights of its three corners: not negative, their sum 1.
    pub barycentric: [f64; 3],
    /// The ray's parameter: the point is `origin + distance * direction`, so a length where the direction is a unit.
    pub distance: f64,
}

/// A hierarchy of boxes over triangles. It keeps its own copy of the positions.
#[derive(Clone)]
pub struct Bvh {
    nodes: Blocks<Node>,
    positions: Blocks<DVec3>,
    /// Boxes of [`RUN`] vertices each that follow one another.
    runs: Vec<Span>,
    leaves: Arc<Leaves>,
    space: BoxSpace,
}

/// The triangles as leaves have them, one after another; never changed.
struct Leaves {
    triangles: Vec<u32>,
    corners: Vec<[SurfaceVertex; 3]>,
}

/// A box, and below it two nodes one after the other or a leaf.
#[derive(Clone, Copy)]
struct Node {
    span: Span,
    /// The first child's number, or of a leaf the place of its first triangle.
    first: u32,
    /// Triangles of a leaf; 0 of any other.
    count: u32,
}

/// A box in box space.
#[derive(Clone, Copy, PartialEq)]
struct Span {
    min: Vec3,
    max: Vec3,
}

/// The space that boxes stand in: the built surface fills the cube from -1 to 1.
#[derive(Clone, Copy)]
struct BoxSpace {
    centre: DVec3,
    scale: f64,
}

/// Boxes grow by this much of the cube, more than the rounding of everything that meets them.
const MARGIN: f32 = 1e-6;

/// Barycentric weights down to this count as inside, so that no ray slips between two triangles.
const EDGE_SLACK: f64 = -1e-9;

/// So many vertices in a row share a box: they stand in Morton order, so a run of them is a patch.
const RUN: usize = 64;

impl Bvh {
    /// A hierarchy over `triangles`, all of them or some, of a surface with these finite `positions`.
    pub fn build(positions: &[DVec3], triangles: &[[SurfaceVertex; 3]]) -> Self {
        let space = BoxSpace::of(positions);
        let boxes: Vec<Aabb> = triangles
            .par_iter()
            .map(|&triangle| space.span(corners(triangle, positions)).aabb())
            .collect();
        let every = (0..triangles.len() as u32).collect();
        let mut tree = PlocBuilder::with_capacity(boxes.len()).build(
            PlocSearchDistance::Low,
            &boxes,
            every,
            SortPrecision::U64,
            2,
        );
        collapse(&mut tree, 4, 1.5);
        let positions = Blocks::of(positions);
        Self {
            runs: (0..positions.len().div_ceil(RUN))
                .map(|run| space.run(&positions, run))
                .collect(),
            leaves: Arc::new(Leaves {
                corners: tree
                    .primitive_indices
                    .iter()
                    .map(|&triangle| triangles[triangle as usize])
                    .collect(),
                triangles: std::mem::take(&mut tree.primitive_indices),
            }),
            nodes: nodes(&tree),
            positions,
            space,
        }
    }

    /// Takes the vertices' new positions, all finite, from `position`. The tree's shape stays, so answers are right but
    /// come slower the more the surface differs from the one it was built for. Takes as long as what moved is large,
    /// after a look at everything.
    pub fn refit(&mut self, position: impl Fn(SurfaceVertex) -> DVec3 + Sync) {
        let mut moved = vec![false; self.positions.len()];
        let blocks = self.positions.each_mut().par_iter_mut();
        blocks
            .zip(moved.par_chunks_mut(BLOCK))
            .enumerate()
            .for_each(|(number, (block, moved))| {
                let position = |place: usize| position(SurfaceVertex((number * BLOCK + place) as u32));
                let mut any = false;
                for (place, moved) in moved.iter_mut().enumerate() {
                    *moved = position(place) != block[place];
                    any |= *moved;
                }
                if any {
                    for (place, old) in Arc::make_mut(block).iter_mut().enumerate() {
                        *old = position(place);
                    }
                }
            });
        let (space, positions) = (self.space, &self.positions);
        let runs = self.runs.par_iter_mut().zip(moved.par_chunks(RUN)).enumerate();
        runs.filter(|(_, (_, moved))| moved.contains(&true))
            .for_each(|(number, (run, _))| *run = space.run(positions, number));
        self.refit_boxes(&moved);
    }

    /// Boxes of everything with a corner that moved.
    fn refit_boxes(&mut self, moved: &[bool]) {
        let (leaves, positions, space) = (&*self.leaves, &self.positions, self.space);
        let mut is_other = vec![false; self.nodes.len()];
        let blocks = self.nodes.each_mut().par_iter_mut();
        blocks
            .zip(is_other.par_chunks_mut(BLOCK))
            .for_each(|(block, is_other)| {
                for (node, is_other) in block.iter().zip(is_other.iter_mut()) {
                    *is_other = node.leaf().is_some_and(|leaf| {
                        leaves.corners[leaf]
                            .iter()
                            .flatten()
                            .any(|vertex| moved[vertex.index()])
                    });
                }
                if is_other.contains(&true) {
                    for (node, _) in Arc::make_mut(block).iter_mut().zip(&*is_other).filter(|(_, is)| **is) {
                        let corners = leaves.corners[node.leaf().unwrap_or_default()].iter();
                        let boxes = corners.map(|corners| space.span(corners.map(|v| positions.get(v.index()))));
                        node.span = boxes.reduce(|a, b| a.union(&b)).unwrap_or(node.span);
                    }
                }
            });
        // Children stand behind their parents.
        for number in (0..self.nodes.len().div_ceil(BLOCK)).rev() {
            let start = number * BLOCK;
            let mut any = false;
            for place in (start..(start + BLOCK).min(self.nodes.len())).rev() {
                let node = self.nodes.get(place);
                if node.count == 0 {
                    is_other[place] = is_other[node.first as usize] || is_other[node.first as usize + 1];
                    any |= is_other[place];
                }
            }
            if any {
                self.nodes.rewrite(number, |block, others| {
                    for place in (0..block.len()).rev() {
                        let Node { first, count, .. } = block[place];
                        if count == 0 && is_other[start + place] {
                            let [a, b] = [first, first + 1].map(|child| match (child as usize).checked_sub(start) {
                                Some(own) if own < block.len() => block[own].span,
                                _ => others.get(child as usize).span,
                            });
                            block[place].span = a.union(&b);
                        }
                    }
                });
            }
        }
    }

    /// The first triangle that the ray from `origin` along `direction` (any length) meets, from either side; of
    /// several at one distance the lowest.
    pub fn ray(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let ray = BoxRay {
            origin: self.space.of_point(origin),
            inverse: (direction * self.space.scale).recip(),
        };
        let mut best: Option<Hit> = None;
        self.walk(
            |span| ray.entry(span),
            |place| {
                if let Some(hit) = self.meet(place, origin, direction)
                    && best.is_none_or(|b| (hit.distance, hit.triangle) < (b.distance, b.triangle))
                {
                    best = Some(hit);
                }
                best.map_or(f64::INFINITY, |hit| hit.distance)
            },
        );
        best
    }

    /// Visits, ascending, the vertices in the convex space before all `planes` (a point p is before one if its product
    /// with (p, 1) is not negative) and some beside it, with their positions: those of triangles that the hierarchy was
    /// not built over, too.
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

    /// The vertex nearest to `point` in a straight line, of several the lowest, and its distance; `None` of an empty
    /// hierarchy.
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

    /// The triangle nearest to `point` whose first corner `is_meant`, of those not farther than `limit`: its corner
    /// nearest to the point, of several the lowest, and the distance to the triangle.
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

    /// Visits the triangles' places in every leaf whose box has a `bound` (infinite: never) not above the limit, nearer
    /// boxes first; `visit` returns the new limit.
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

    /// Möller and Trumbore 1997, both sides.
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

/// The nodes of a tree whose children stand behind their parents, as obvhs's builder leaves them.
fn nodes(tree: &Bvh2) -> Blocks<Node> {
    debug_assert!(tree.children_are_ordered_after_parents || tree.nodes.is_empty());
    let nodes: Vec<Node> = tree
        .nodes
        .iter()
        .map(|node| Node {
            span: Span {
                min: node.aabb().min.into(),
                max: node.aabb().max.into(),
            },
            first: node.first_index,
            count: node.prim_count,
        })
        .collect();
    Blocks::of(&nodes)
}

impl Node {
    /// The places of a leaf's triangles.
    fn leaf(&self) -> Option<std::ops::Range<usize>> {
        (self.count > 0).then(|| self.first as usize..(self.first + self.count) as usize)
    }
}

impl Span {
    fn aabb(&self) -> Aabb {
        Aabb::new(Vec3A::from(self.min), Vec3A::from(self.max))
    }

    fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The distance of a point, 0 inside.
    fn distance(&self, point: DVec3) -> f64 {
        let outside = (self.min.as_dvec3() - point).max(point - self.max.as_dvec3());
        outside.max(DVec3::ZERO).length()
    }
}

impl BoxSpace {
    fn of(positions: &[DVec3]) -> Self {
        let Some(bounds) = bounding_box(positions) else {
            return Self {
                centre: DVec3::ZERO,
                scale: 1.0,
            };
        };
        let scale = 2.0 / bounds.extent().max_element();
        Self {
            centre: bounds.centre(),
            scale: if scale.is_finite() { scale } else { 1.0 },
        }
    }

    fn of_point(&self, point: DVec3) -> DVec3 {
        (point - self.centre) * self.scale
    }

    /// The f32 box of some points, rounded outward.
    fn span(&self, points: impl IntoIterator<Item = DVec3>) -> Span {
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for point in points {
            let point = self.of_point(point);
            (min, max) = (min.min(point), max.max(point));
        }
        // Relative as well: a refitted surface may have left the cube.
        let margin = MARGIN * (1.0 + min.abs().max(max.abs()).max_element() as f32);
        Span {
            min: min.as_vec3() - Vec3::splat(margin),
            max: max.as_vec3() + Vec3::splat(margin),
        }
    }

    /// The box of a run of vertices.
    fn run(&self, positions: &Blocks<DVec3>, run: usize) -> Span {
        let vertices = run * RUN..((run + 1) * RUN).min(positions.len());
        self.span(vertices.map(|vertex| positions.get(vertex)))
    }
}

/// A ray in box space; its parameter is the world ray's.
struct BoxRay {
    origin: DVec3,
    inverse: DVec3,
}

impl BoxRay {
    /// Where the ray enters the box, not before its origin; infinite where it misses.
    fn entry(&self, span: &Span) -> f64 {
        let to_min = (span.min.as_dvec3() - self.origin) * self.inverse;
        let to_max = (span.max.as_dvec3() - self.origin) * self.inverse;
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            // Zero times infinity, for a ray inside a wall's plane, is NaN, which `min` and `max` pass over.
            enter = enter.max(to_min[axis].min(to_max[axis]));
            leave = leave.min(to_min[axis].max(to_max[axis]));
        }
        if enter <= leave { enter } else { f64::INFINITY }
    }
}
