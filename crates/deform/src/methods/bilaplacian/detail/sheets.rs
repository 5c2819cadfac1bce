//! Thin sheets: the two sides of a closed sheet keep about their rest distance.
//!
//! A base has no thickness if it is faired to a line or if both sides shrink onto each other, so details that each side
//! puts back alone move the back through the front, or spread at the rim. A vertex p is *opposite* the point q where a
//! ray into the body leaves it again. The middles (p + q) / 2 are a surface that no side moves alone, so they show the
//! sheet's turn: with R, the turn of the middles' ring, the thickness o = p − q should become R o. The difference is
//! limited to a share of its length, and each side moves by half of the excess, or by all of it if the other side is
//! held.
//!
//! Smaller differences stay to the last bit as the details make them.

use glam::{DMat3, DVec3};
use pliant_mesh::{Bounds, Bvh, SurfaceVertex};
use rayon::prelude::*;

use super::frames::RingFrames;
use super::opposing::{OpposingGrid, Reached};
use crate::method::BindInput;
use crate::numerical::rows::CHUNK;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::patch::Patch;

/// A sheet is thinner than this, in sizes of the bending part.
const THICKEST: f64 = 0.04;

/// The allowed difference of a thickness, in units of its own length, where the sheet is thinnest. It grows towards
/// [`THICKEST`], so that a sheet ends without a seam.
const SLACK: f64 = 0.25;

/// Opposite sides face away from each other by at least this much.
const FACING: f64 = -0.5;

/// Faces of one vertex are on different sides of it if their normals' product is less.
const SAME_SIDE: f64 = 0.7;

/// The middles around a vertex are a surface if they have at least this share of the area of its own faces: those of a
/// limb are near its axis.
const BROAD: f64 = 0.4;

/// The start of rays inside the face, as a share of the way from the vertex to its centre, and below it, in sizes.
const INSIDE: f64 = 0.01;
const BELOW: f64 = 1e-6;

/// The length of the grid's cells, in rays.
const CELL: f64 = 0.5;

/// The sheets of the bending part.
#[derive(Debug)]
pub(crate) struct Sheets {
    /// The middles around the sheets' solved vertices.
    patch: Patch,
    rings: RingFrames,
    /// Data of each local vertex of the patch.
    opposites: Vec<Option<Opposite>>,
    /// Data of each row.
    thicknesses: Vec<Thickness>,
    scratch: Scratch,
}

/// The point opposite a vertex, by the corners of its triangle.
#[derive(Clone, Copy, Debug)]
struct Opposite {
    corners: [u32; 3],
    weights: [f64; 3],
    /// From there to the vertex.
    offset: DVec3,
}

/// The data of a row's frame.
#[derive(Clone, Copy, Debug)]
struct Thickness {
    /// The vertex's share in the motion of both sides.
    share: f64,
    /// The allowed difference of the offset.
    slack: f64,
    /// The ring's frame at rest, transposed; `None` if it has none.
    unturned: Option<DMat3>,
}

/// Buffers kept from frame to frame, so that no frame allocates them.
#[derive(Debug, Default)]
struct Scratch {
    middles: Vec<DVec3>,
    corrections: Vec<DVec3>,
}

impl Sheets {
    /// Searches the solved part for sheets; `None` if there are none.
    pub fn of(input: &BindInput<'_>) -> Option<Self> {
        let &BindInput { problem, partition, .. } = input;
        let surface = Patch::of(problem, &partition.solved, |vertex| problem.surface.positions[vertex]);
        let finder = Finder::new(problem, &surface)?;
        let around: Vec<Option<Opposite>> = surface
            .vertices
            .par_iter()
            .zip(&finder.may_have)
            .with_min_len(CHUNK)
            .map_init(Vec::new, |faces, (&vertex, &may_have)| {
                let opposite = may_have.then(|| finder.opposite(SurfaceVertex(vertex), faces));
                opposite.flatten()
            })
            .collect();
        let opposite = |vertex: u32| around[surface.vertices.binary_search(&vertex).ok()?];
        let solved = partition.solved.iter().copied();
        let area_at = |place: &dyn Fn(u32) -> DVec3, face: u32| {
            let [a, b, c] = problem.surface.triangles[face as usize].map(|corner| place(corner.0));
            (b - a).cross(c - a).length()
        };
        let own = |vertex: u32| problem.surface.positions[vertex as usize];
        let middle = |vertex: u32| own(vertex) - opposite(vertex).map_or(DVec3::ZERO, |found| found.offset * 0.5);
        let is_broad = |vertex: u32| {
            let faces = || {
                problem
                    .topology
                    .faces(SurfaceVertex(vertex), &problem.surface.triangles)
            };
            let area = |place: &dyn Fn(u32) -> DVec3| faces().map(|face| area_at(place, face)).sum::<f64>();
            area(&middle) > BROAD * area(&own)
        };
        let is_thin = |&vertex: &u32| opposite(vertex).is_some() && is_broad(vertex);
        let thin: Vec<u32> = solved.filter(is_thin).collect();
        if thin.is_empty() {
            return None;
        }
        let patch = Patch::of(problem, &thin, |vertex| middle(vertex as u32));
        let rings = RingFrames::of(&patch, &problem.surface.triangles, problem.topology);
        let opposites: Vec<Option<Opposite>> = patch.vertices.iter().map(|&vertex| opposite(vertex)).collect();
        let is_solved = |vertex: u32| partition.solved.binary_search(&vertex).is_ok();
        let thickness = |row: usize| {
            let opposite = opposites[patch.rows[row] as usize]?;
            let corners = opposite.corners.into_iter().zip(opposite.weights);
            let free: f64 = corners.filter(|(corner, _)| is_solved(*corner)).map(|(_, w)| w).sum();
            let length = opposite.offset.length();
            let thick = length / (THICKEST * patch.size);
            Some(Thickness {
                share: 1.0 / (1.0 + free),
                slack: SLACK * length / (1.0 - thick),
                unturned: rings.frame(&patch, row, &patch.rest).map(|frame| frame.transpose()),
            })
        };
        Some(Self {
            thicknesses: (0..patch.rows.len()).filter_map(thickness).collect(),
            patch,
            rings,
            opposites,
            scratch: Scratch::default(),
        })
    }

    /// Brings the sides of the sheets back together.
    pub fn restore(&mut self, displacements: &mut [DVec3]) {
        let Scratch { middles, corrections } = &mut self.scratch;
        let patch = &self.patch;
        let at = |vertex: u32| displacements[vertex as usize];
        let across = |opposite: &Opposite| {
            let corners = opposite.corners.into_iter().zip(opposite.weights);
            corners.map(|(corner, weight)| at(corner) * weight).sum::<DVec3>()
        };
        let middle = |((rest, &vertex), opposite): ((&DVec3, &u32), &Option<Opposite>)| {
            let own = at(vertex);
            *rest + opposite.as_ref().map_or(own, |opposite| (own + across(opposite)) * 0.5)
        };
        let locals = patch.rest.par_iter().zip(&patch.vertices).zip(&self.opposites);
        locals.with_min_len(CHUNK).map(middle).collect_into_vec(middles);
        let correction = |(row, (&local, thickness)): (usize, (&u32, &Thickness))| {
            let local = local as usize;
            let wanted = || {
                let opposite = self.opposites[local].as_ref()?;
                let turn = self.rings.frame(patch, row, middles)? * thickness.unturned?;
                let now = opposite.offset + (at(patch.vertices[local]) - across(opposite));
                Some(turn * opposite.offset - now)
            };
            let missing = wanted().unwrap_or(DVec3::ZERO);
            let excess = 1.0 - thickness.slack / missing.length();
            if excess > 0.0 {
                missing * (excess * thickness.share)
            } else {
                DVec3::ZERO
            }
        };
        let rows = patch.rows.par_iter().zip(&self.thicknesses).enumerate();
        rows.with_min_len(CHUNK).map(correction).collect_into_vec(corrections);
        for (&local, correction) in patch.rows.iter().zip(corrections) {
            displacements[patch.vertices[local as usize] as usize] += *correction;
        }
    }
}

/// Finds the points opposite vertices.
struct Finder<'p> {
    sides: Sides<'p>,
    /// For each local vertex of the patch, false if nothing can be opposite it.
    may_have: Vec<bool>,
    /// Searches the triangles near the others.
    hierarchy: Bvh,
    triangles: Vec<u32>,
}

impl<'p> Finder<'p> {
    /// `None` if nothing is opposite any vertex.
    fn new(problem: &'p BoundaryProblem<'p>, patch: &Patch) -> Option<Self> {
        let sides = Sides {
            problem,
            size: patch.size,
        };
        let surface = problem.surface;
        let near = Bounds::around(patch.rest.iter().copied())?.grown(THICKEST * patch.size);
        let is_near = |&triangle: &u32| {
            let own = Bounds::around(sides.corners(triangle).into_iter());
            own.is_some_and(|own| near.meets(&own))
        };
        let all = 0..surface.triangles.len() as u32;
        let mut triangles: Vec<u32> = all.filter(is_near).collect();
        let mut grid = OpposingGrid::new(near, CELL * THICKEST * patch.size, FACING);
        for &triangle in &triangles {
            grid.add(sides.corners(triangle), sides.area(triangle));
        }
        let may_have: Vec<bool> = patch
            .vertices
            .par_iter()
            .with_min_len(CHUNK)
            .map_init(Vec::new, |faces, &vertex| {
                let mut may_meet = false;
                sides.each_ray(SurfaceVertex(vertex), faces, |origin, normal| {
                    may_meet |= grid.may_meet(origin, sides.end(origin, normal), normal);
                });
                may_meet
            })
            .collect();
        let (mut reached, mut faces) = (Reached::none(&grid), Vec::new());
        let mut is_any = false;
        for (&vertex, _) in patch.vertices.iter().zip(&may_have).filter(|(_, may_have)| **may_have) {
            sides.each_ray(SurfaceVertex(vertex), &mut faces, |origin, normal| {
                reached.mark(&grid, origin, sides.end(origin, normal));
            });
            is_any = true;
        }
        if !is_any {
            return None;
        }
        triangles.retain(|&triangle| reached.holds(&grid, sides.corners(triangle)));
        let corners: Vec<_> = triangles.iter().map(|&t| surface.triangles[t as usize]).collect();
        Some(Self {
            hierarchy: Bvh::build(&surface.positions, &corners),
            triangles,
            may_have,
            sides,
        })
    }

    /// The nearest point opposite a vertex, seen from the largest face of each of its sides.
    fn opposite(&self, vertex: SurfaceVertex, faces: &mut Vec<Face>) -> Option<Opposite> {
        let mut nearest: Option<Opposite> = None;
        self.sides.each_ray(vertex, faces, |origin, normal| {
            let limit = nearest.map_or(THICKEST * self.sides.size, |nearest| nearest.offset.length());
            nearest = self.below(vertex, origin, normal, limit).or(nearest);
        });
        nearest
    }

    /// The point opposite a vertex on the ray from `origin` against a face's normal, nearer than `limit`.
    fn below(&self, vertex: SurfaceVertex, origin: DVec3, normal: DVec3, limit: f64) -> Option<Opposite> {
        let BoundaryProblem { surface, topology, .. } = self.sides.problem;
        let position = |vertex: SurfaceVertex| surface.positions[vertex.index()];
        let hit = self.hierarchy.ray_within(origin, -normal, limit)?;
        let met = self.triangles[hit.triangle as usize];
        let facing = self.sides.area(met).try_normalize()?;
        let corners = surface.triangles[met as usize];
        if facing.dot(normal) > FACING || topology.component(corners[0]) != topology.component(vertex) {
            return None;
        }
        let across: DVec3 = corners.iter().zip(hit.barycentric).map(|(c, w)| position(*c) * w).sum();
        let offset = position(vertex) - across;
        (offset.length() < limit).then_some(Opposite {
            corners: corners.map(|corner| corner.0),
            weights: hit.barycentric,
            offset,
        })
    }
}

/// A face of a vertex.
#[derive(Clone, Copy)]
struct Face {
    number: u32,
    /// Twice its area vector, and the square of that.
    area: DVec3,
    square: f64,
}

/// The sides of vertices, from which rays go into the body.
struct Sides<'p> {
    problem: &'p BoundaryProblem<'p>,
    size: f64,
}

impl Sides<'_> {
    /// Visits the rays of a vertex into the body: their origins below the largest face of each of its sides, and the
    /// faces' unit normals. `faces` is only a buffer.
    fn each_ray(&self, vertex: SurfaceVertex, faces: &mut Vec<Face>, mut visit: impl FnMut(DVec3, DVec3)) {
        let BoundaryProblem { surface, topology, .. } = self.problem;
        faces.clear();
        faces.extend(topology.faces(vertex, &surface.triangles).map(|number| {
            let area = self.area(number);
            let square = area.length_squared();
            Face { number, area, square }
        }));
        let own = surface.positions[vertex.index()];
        // The first of the largest faces; then the largest of those that are not on its side.
        while let Some(largest) = (faces.iter().copied()).reduce(|a, b| if b.square > a.square { b } else { a }) {
            let Some(normal) = largest.area.try_normalize() else {
                faces.retain(|face| face.number != largest.number);
                continue;
            };
            faces.retain(|face| {
                face.number != largest.number && normal.dot(face.area) <= SAME_SIDE * face.square.sqrt()
            });
            let centre = self.corners(largest.number).iter().sum::<DVec3>() / 3.0;
            visit(own.lerp(centre, INSIDE) - normal * (BELOW * self.size), normal);
        }
    }

    /// The end of a ray.
    fn end(&self, origin: DVec3, normal: DVec3) -> DVec3 {
        origin - normal * (THICKEST * self.size)
    }

    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        let surface = self.problem.surface;
        surface.triangles[triangle as usize].map(|corner| surface.positions[corner.index()])
    }

    /// Twice a triangle's area vector.
    fn area(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a)
    }
}
