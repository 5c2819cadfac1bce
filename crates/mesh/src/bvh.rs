//! A bounding-volume hierarchy over a surface's triangles: rays, balls and nearest vertices, refitted while it moves.
//!
//! obvhs builds the tree (PLOC, Meister and Bittner 2018); walking it is done here, because its own traversal works in
//! f32 throughout. Boxes are f32, relative to a centre and scaled to the unit cube, and rounded outward; positions and
//! all tests on them are f64. So a surface at geographic coordinates is hit as exactly as one at the origin.

use glam::{DVec3, DVec4, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use rayon::prelude::*;

use crate::surface::corners;
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
    tree: Bvh2,
    positions: Vec<DVec3>,
    triangles: Vec<[SurfaceVertex; 3]>,
    space: BoxSpace,
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

impl Bvh {
    /// A hierarchy over `triangles`, all of them or some, of a surface with these finite `positions`.
    pub fn build(positions: &[DVec3], triangles: &[[SurfaceVertex; 3]]) -> Self {
        let space = BoxSpace::of(positions);
        let boxes: Vec<Aabb> = triangles
            .par_iter()
            .map(|&triangle| space.triangle_box(corners(triangle, positions)))
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
        Self {
            tree,
            positions: positions.to_vec(),
            triangles: triangles.to_vec(),
            space,
        }
    }

    /// Takes the vertices' new `positions`, as many as at the building. The tree's shape stays, so answers are right
    /// but come slower the more the surface differs from the one it was built for.
    pub fn refit(&mut self, positions: &[DVec3]) {
        self.positions.clear();
        self.positions.extend_from_slice(positions);
        let (order, triangles, space) = (&self.tree.primitive_indices, &self.triangles, self.space);
        self.tree
            .nodes
            .par_iter_mut()
            .with_min_len(4096)
            .filter(|node| node.is_leaf())
            .for_each(|node| {
                let leaf = &order[node.first_index as usize..(node.first_index + node.prim_count) as usize];
                let boxes = leaf
                    .iter()
                    .map(|&t| space.triangle_box(corners(triangles[t as usize], positions)));
                if let Some(all) = boxes.reduce(|a, b| a.union(&b)) {
                    node.set_aabb(all);
                }
            });
        self.tree.refit_all();
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
            |node_box| ray.entry(node_box),
            |triangle| {
                if let Some(hit) = self.meet(triangle, origin, direction)
                    && best.is_none_or(|b| (hit.distance, hit.triangle) < (b.distance, b.triangle))
                {
                    best = Some(hit);
                }
                best.map_or(f64::INFINITY, |hit| hit.distance)
            },
            f64::INFINITY,
        );
        best
    }

    /// The vertices of triangles in the hierarchy that lie within `radius` of `centre` in a straight line, ascending,
    /// into `out`, whose old contents go.
    pub fn vertices_in_ball(&self, centre: DVec3, radius: f64, out: &mut Vec<SurfaceVertex>) {
        out.clear();
        let (ball, limit) = (self.space.of_point(centre), radius * self.space.scale);
        self.walk(
            |node_box| box_distance(node_box, ball),
            |triangle| {
                out.extend(
                    self.triangles[triangle as usize]
                        .iter()
                        .filter(|v| self.positions[v.index()].distance_squared(centre) <= radius * radius),
                );
                limit
            },
            limit,
        );
        out.sort_unstable();
        out.dedup();
    }

    /// Visits the triangles that may reach into the convex space before all `planes` (a point p is before one if its
    /// product with (p, 1) is not negative): every one that does, and some beside it.
    pub fn triangles_within(&self, planes: &[DVec4], mut visit: impl FnMut(u32)) {
        // In the boxes' space the same planes have other lengths and distances.
        let planes: Vec<DVec4> = planes
            .iter()
            .map(|plane| {
                let normal = plane.truncate() / self.space.scale;
                normal.extend(plane.w + plane.truncate().dot(self.space.centre))
            })
            .collect();
        let is_apart = |node_box: &Aabb| {
            let (min, max) = (node_box.min.as_dvec3(), node_box.max.as_dvec3());
            planes.iter().any(|plane| {
                let farthest = DVec3::select(plane.truncate().cmpge(DVec3::ZERO), max, min);
                plane.dot(farthest.extend(1.0)) < 0.0
            })
        };
        self.walk(
            |node_box| if is_apart(node_box) { f64::INFINITY } else { 0.0 },
            |triangle| {
                visit(triangle);
                f64::MAX
            },
            f64::MAX,
        );
    }

    /// The vertex nearest to `point` in a straight line, of several the lowest, and its distance; `None` of an empty
    /// hierarchy.
    pub fn nearest_vertex(&self, point: DVec3) -> Option<(SurfaceVertex, f64)> {
        let in_boxes = self.space.of_point(point);
        let mut best: Option<(f64, SurfaceVertex)> = None;
        self.walk(
            |node_box| box_distance(node_box, in_boxes),
            |triangle| {
                for &v in &self.triangles[triangle as usize] {
                    let candidate = (self.positions[v.index()].distance(point), v);
                    if best.is_none_or(|best| candidate < best) {
                        best = Some(candidate);
                    }
                }
                best.map_or(f64::INFINITY, |(distance, _)| distance * self.space.scale)
            },
            f64::INFINITY,
        );
        best.map(|(distance, v)| (v, distance))
    }

    /// Visits the triangles of every leaf whose box has a `bound` (infinite: never) not above the limit, nearer boxes
    /// first; `visit` returns the new limit.
    fn walk(&self, bound: impl Fn(&Aabb) -> f64, mut visit: impl FnMut(u32) -> f64, mut limit: f64) {
        let nodes = &self.tree.nodes;
        let Some(root) = nodes.first() else { return };
        let mut stack = Vec::with_capacity(64);
        stack.push((bound(root.aabb()), 0));
        while let Some((lower_bound, index)) = stack.pop() {
            if lower_bound > limit || lower_bound == f64::INFINITY {
                continue;
            }
            let node = &nodes[index];
            let first = node.first_index as usize;
            if node.is_leaf() {
                for &triangle in &self.tree.primitive_indices[first..first + node.prim_count as usize] {
                    limit = visit(triangle);
                }
            } else {
                let children = [first, first + 1].map(|child| (bound(nodes[child].aabb()), child));
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
    fn meet(&self, triangle: u32, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let [a, b, c] = corners(self.triangles[triangle as usize], &self.positions);
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
            triangle,
            barycentric,
            distance,
        })
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

    /// The f32 box of a triangle, rounded outward.
    fn triangle_box(&self, corners: [DVec3; 3]) -> Aabb {
        let [a, b, c] = corners.map(|corner| self.of_point(corner));
        let (min, max) = (a.min(b).min(c), a.max(b).max(c));
        // Relative as well: a refitted surface may have left the cube.
        let margin = MARGIN * (1.0 + min.abs().max(max.abs()).max_element() as f32);
        Aabb::new(
            min.as_vec3a() - Vec3A::splat(margin),
            max.as_vec3a() + Vec3A::splat(margin),
        )
    }
}

/// A ray in box space; its parameter is the world ray's.
struct BoxRay {
    origin: DVec3,
    inverse: DVec3,
}

impl BoxRay {
    /// Where the ray enters the box, not before its origin; infinite where it misses.
    fn entry(&self, node_box: &Aabb) -> f64 {
        let to_min = (node_box.min.as_dvec3() - self.origin) * self.inverse;
        let to_max = (node_box.max.as_dvec3() - self.origin) * self.inverse;
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            // Zero times infinity, for a ray inside a wall's plane, is NaN, which `min` and `max` pass over.
            enter = enter.max(to_min[axis].min(to_max[axis]));
            leave = leave.min(to_min[axis].max(to_max[axis]));
        }
        if enter <= leave { enter } else { f64::INFINITY }
    }
}

/// The distance from a point to a box, 0 inside.
fn box_distance(node_box: &Aabb, point: DVec3) -> f64 {
    let outside = (node_box.min.as_dvec3() - point).max(point - node_box.max.as_dvec3());
    outside.max(DVec3::ZERO).length()
}
