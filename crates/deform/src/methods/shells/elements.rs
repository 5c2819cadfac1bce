//! The edges, hinges and triangles at the solved vertices, numbered for the solver.
//!
//! The solved vertices come first among the local ones, in the order of elimination; then follow all others that an
//! edge or a hinge needs.

use glam::DVec3;
use pliant_mesh::{Cancel, Surface, SurfaceVertex, face_area};
use rayon::prelude::*;

use super::Shells;
use super::hinge::angle_rad;
use crate::BindError;
use crate::methods::primo::edges::{CROWD, area};
use crate::numerical::rows::CHUNK;
use crate::region::boundary_problem::BoundaryProblem;
use crate::sparse::Elimination;
use crate::sparse::ordering::graph::elimination;

/// The number of an absent local vertex.
pub(super) const ABSENT: u32 = u32::MAX;

/// k_a, in units of `stretching`. Without it triangles at the inside of a bend collapse within their plane until they
/// have no area; with half of it those of a strongly bent tube and of a sheet that is compressed by 30% still do. A
/// stretched surface of equilateral triangles narrows by 0.6 times as much: by a third with edges alone, and rubber by
/// a half.
const AREA: f64 = 0.25;

/// An edge counts as at least this share of the longest edge of its triangles, so that one without a length resists
/// stretching firmly, but remains computable; a triangle counts as at least this share of that edge's square.
const LENGTH_FLOOR: f64 = 1e-2;

/// Triangles that are lower than this share of their edge hold the hinge there less firmly, by the square: the
/// slightest move changes their angle. Much lower ones have no hinge there.
const HEIGHT_FLOOR: f64 = 1e-2;

/// A share like [`HEIGHT_FLOOR`]: a triangle below it has no angle that could be computed.
const NO_HEIGHT: f64 = 1e-6;

/// The surface around the solved vertices, as far as the energy needs it.
#[derive(Clone, Debug)]
pub(super) struct Elements {
    /// The surface vertex of each local one.
    pub vertices: Vec<u32>,
    /// The number of solved vertices.
    pub solved_count: usize,
    /// Rest positions relative to the solver's origin, in world units.
    pub rest: Vec<DVec3>,
    pub edges: Vec<Edge>,
    pub hinges: Vec<Hinge>,
    pub faces: Vec<Face>,
    /// The area of the edges, in squared world units.
    pub area: f64,
    /// The number of triangles that are too flat to form an angle with others.
    pub flat_faces: usize,
}

/// An edge: ½ weight (l − length)².
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub ends: [u32; 2],
    pub length: f64,
    pub weight: f64,
}

/// Two triangles at an edge: ½ weight (θ − angle)².
#[derive(Clone, Copy, Debug)]
pub(super) struct Hinge {
    /// The edge's ends and the vertices across it.
    pub corners: [u32; 4],
    pub angle_rad: f64,
    pub weight: f64,
}

/// A triangle: ½ weight (A − area)², and below its `least` area a barrier ([`super::face`]).
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub corners: [u32; 3],
    pub area: f64,
    pub weight: f64,
    /// The smallest area that rest and examples give it.
    pub least: f64,
}

/// A side of a triangle: the edge's lower vertex, its higher one, and the triangle.
type Side = (u32, u32, u32);

/// The elements before the vertices have their numbers: surface vertices, weights, and areas.
#[derive(Default)]
struct Collected {
    edges: Vec<Edge>,
    hinges: Vec<Hinge>,
    faces: Vec<Face>,
    area: f64,
    flat: Vec<u32>,
}

impl Elements {
    /// Collects the elements of the solved surface vertices. Returns also the end of each supernode of the elimination
    /// order.
    ///
    /// # Errors
    /// [`BindError::Cancelled`].
    pub fn of(
        problem: &BoundaryProblem,
        options: &Shells,
        solved: &[u32],
        world_origin: DVec3,
        cancel: &Cancel,
    ) -> Result<(Self, Vec<u32>), BindError> {
        let surface = problem.surface;
        let mut number = vec![ABSENT; surface.positions.len()];
        for (place, &vertex) in (0..).zip(solved) {
            number[vertex as usize] = place;
        }
        let mut found = collected(problem, options, &number, world_origin);
        cancel.check()?;
        let (offsets, neighbours) = graph(&found, &number, solved.len());
        let Elimination { order, ends } = elimination(&offsets, &neighbours, cancel)?;
        let mut vertices: Vec<u32> = order.iter().map(|&place| solved[place as usize]).collect();
        for (place, &vertex) in (0..).zip(&vertices) {
            number[vertex as usize] = place;
        }
        let mut numbered = |vertex: &mut u32| {
            let own = &mut number[*vertex as usize];
            if *own == ABSENT {
                *own = vertices.len() as u32;
                vertices.push(*vertex);
            }
            *vertex = *own;
        };
        found
            .edges
            .iter_mut()
            .for_each(|edge| edge.ends.iter_mut().for_each(&mut numbered));
        found
            .hinges
            .iter_mut()
            .for_each(|hinge| hinge.corners.iter_mut().for_each(&mut numbered));
        found
            .faces
            .iter_mut()
            .for_each(|face| face.corners.iter_mut().for_each(&mut numbered));
        // Neighbours in the numbering are neighbours in memory.
        found.edges.par_sort_unstable_by_key(|edge| edge.ends);
        found.hinges.par_sort_unstable_by_key(|hinge| hinge.corners);
        found.faces.par_sort_unstable_by_key(|face| face.corners);
        found.flat.sort_unstable();
        found.flat.dedup();
        let elements = Self {
            rest: vertices
                .iter()
                .map(|&v| surface.positions[v as usize] - world_origin)
                .collect(),
            vertices,
            solved_count: solved.len(),
            edges: found.edges,
            hinges: found.hinges,
            faces: found.faces,
            area: found.area,
            flat_faces: found.flat.len(),
        };
        Ok((elements, ends))
    }

    /// The local vertex of each surface vertex, [`ABSENT`] where there is none.
    pub fn local_of(&self, surface_count: usize) -> Vec<u32> {
        let mut local_of = vec![ABSENT; surface_count];
        for (local, &vertex) in (0..).zip(&self.vertices) {
            local_of[vertex as usize] = local;
        }
        local_of
    }

    /// Adds a vertex that no edge needs and returns its number.
    pub fn add(&mut self, local_of: &mut [u32], surface_vertex: u32, position: DVec3) -> u32 {
        let local = &mut local_of[surface_vertex as usize];
        if *local == ABSENT {
            *local = self.vertices.len() as u32;
            self.vertices.push(surface_vertex);
            self.rest.push(position);
        }
        *local
    }
}

/// The edges and hinges, by surface vertices; `number` marks the solved ones.
fn collected(problem: &BoundaryProblem, options: &Shells, number: &[u32], world_origin: DVec3) -> Collected {
    let BoundaryProblem { surface, topology, .. } = *problem;
    let is_solved = |vertex: u32| number[vertex as usize] != ABSENT;
    let mut is_near: Vec<bool> = number.iter().map(|&place| place != ABSENT).collect();
    for vertex in (0..number.len() as u32).filter(|&vertex| is_solved(vertex)) {
        for neighbour in topology.neighbours(SurfaceVertex(vertex)) {
            is_near[neighbour.index()] = true;
        }
    }
    let mut sides: Vec<Side> = Vec::new();
    for (face, corners) in (0..).zip(&surface.triangles) {
        if corners.iter().any(|corner| is_near[corner.index()]) {
            let [a, b, c] = corners.map(|corner| corner.0);
            sides.extend([(a, b), (b, c), (c, a)].map(|(one, other)| (one.min(other), one.max(other), face)));
        }
    }
    sides.par_sort_unstable();
    let size = problem.size();
    let material = Material {
        surface,
        stiffness: problem.stiffness,
        stretching: options.stretching,
        bending: options.bending * size * size,
        world_origin,
    };
    let mut found = Collected::default();
    for group in sides.chunk_by(|one, other| (one.0, one.1) == (other.0, other.1)) {
        let (a, b, _) = group[0];
        if is_solved(a) || is_solved(b) {
            material.add_edge(group, &mut found);
        }
        material.add_hinges(group, &is_solved, &mut found);
    }
    for (face, corners) in (0..).zip(&surface.triangles) {
        let corners = corners.map(|corner| corner.0);
        if corners.into_iter().any(is_solved) {
            material.add_face(face, corners, &mut found);
        }
    }
    found
}

struct Material<'a> {
    surface: &'a Surface,
    stiffness: &'a [f64],
    stretching: f64,
    /// In squared world units.
    bending: f64,
    world_origin: DVec3,
}

impl Material<'_> {
    fn at(&self, vertex: u32) -> DVec3 {
        self.surface.positions[vertex as usize] - self.world_origin
    }

    /// The mean stiffness of an edge's ends.
    fn stiffness(&self, a: u32, b: u32) -> f64 {
        0.5 * (self.stiffness[a as usize] + self.stiffness[b as usize])
    }

    fn add_edge(&self, group: &[Side], found: &mut Collected) {
        let (a, b, _) = group[0];
        let share = group.iter().map(|side| area(self.surface, side.2)).sum::<f64>() / 3.0;
        let length = self.at(a).distance(self.at(b));
        let longest = group
            .iter()
            .fold(length, |most, &(.., face)| most.max(self.longest(face)));
        let floored = length.max(LENGTH_FLOOR * longest);
        found.area += share;
        if floored > 0.0 {
            found.edges.push(Edge {
                ends: [a, b],
                length,
                weight: self.stretching * self.stiffness(a, b) * share / (floored * floored),
            });
        }
    }

    fn add_face(&self, number: u32, corners: [u32; 3], found: &mut Collected) {
        // The energy's own formula, so that the energy is zero at rest to the last bit.
        let area = face_area(corners.map(|corner| self.at(corner)));
        let floored = area.max(LENGTH_FLOOR * self.longest(number).powi(2));
        if area > 0.0 {
            let [a, b, c] = corners.map(|corner| self.stiffness[corner as usize]);
            let weight = AREA * self.stretching * (a + b + c) / 3.0 * area / (floored * floored);
            found.faces.push(Face {
                corners,
                area,
                weight,
                least: area,
            });
        }
    }

    fn longest(&self, face: u32) -> f64 {
        let [a, b, c] = self.surface.triangles[face as usize].map(|corner| self.at(corner.0));
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    }

    /// Adds a hinge for each pair of the edge's triangles, or for each triangle with the largest.
    fn add_hinges(&self, group: &[Side], is_solved: &impl Fn(u32) -> bool, found: &mut Collected) {
        if group.len() <= CROWD {
            let weaker = 1.0 / (group.len() as f64 - 1.0);
            for (place, one) in group.iter().enumerate() {
                group[place + 1..]
                    .iter()
                    .for_each(|other| self.add_hinge(one, other, weaker, is_solved, found));
            }
            return;
        }
        let size = |side: &&Side| area(self.surface, side.2);
        if let Some(middle) = group
            .iter()
            .max_by(|a, b| size(a).total_cmp(&size(b)).then(b.2.cmp(&a.2)))
        {
            let others = group.iter().filter(|other| other.2 != middle.2);
            others.for_each(|other| self.add_hinge(middle, other, 1.0, is_solved, found));
        }
    }

    fn add_hinge(
        &self,
        one: &Side,
        other: &Side,
        weaker: f64,
        is_solved: &impl Fn(u32) -> bool,
        found: &mut Collected,
    ) {
        let &(a, b, _) = one;
        let across = |side: &Side| {
            let corners = self.surface.triangles[side.2 as usize].map(|corner| corner.0);
            corners.into_iter().find(|&corner| corner != a && corner != b)
        };
        let (Some(c), Some(d)) = (across(one), across(other)) else {
            return;
        };
        let corners = [a, b, c, d];
        if c == d || !corners.into_iter().any(is_solved) {
            return;
        }
        let points = corners.map(|corner| self.at(corner));
        let length = points[0].distance(points[1]);
        let height = |corner: DVec3| (points[1] - points[0]).cross(corner - points[0]).length() / (length * length);
        let mut firm = 1.0;
        for (corner, face) in [(points[2], one.2), (points[3], other.2)] {
            let height = height(corner);
            if height.is_nan() || height <= NO_HEIGHT {
                found.flat.push(face);
                return;
            }
            firm *= (height / HEIGHT_FLOOR).min(1.0).powi(2);
        }
        let share = (area(self.surface, one.2) + area(self.surface, other.2)) / 3.0;
        let weight = self.bending * self.stiffness(a, b) * weaker * firm * length * length / share;
        found.hinges.push(Hinge {
            corners,
            angle_rad: angle_rad(points),
            weight,
        });
    }
}

/// The graph of the solved vertices that share an edge or a hinge, as compressed rows, ascending.
fn graph(found: &Collected, number: &[u32], count: usize) -> (Vec<u32>, Vec<u32>) {
    // Edges join a hinge's vertices except the two across it.
    let across = found.hinges.iter().map(|hinge| [hinge.corners[2], hinge.corners[3]]);
    let pairs = || found.edges.iter().map(|edge| edge.ends).chain(across.clone());
    let places = || {
        let numbered = pairs().map(|pair| pair.map(|vertex| number[vertex as usize]));
        numbered.filter(|pair| !pair.contains(&ABSENT))
    };
    let mut offsets = vec![0_u32; count + 1];
    places().flatten().for_each(|place| offsets[place as usize + 1] += 1);
    for place in 0..count {
        offsets[place + 1] += offsets[place];
    }
    let mut next = offsets.clone();
    let mut list = vec![0; offsets[count] as usize];
    for [one, other] in places() {
        for (from, to) in [(one, other), (other, one)] {
            list[next[from as usize] as usize] = to;
            next[from as usize] += 1;
        }
    }
    let rows: Vec<Vec<u32>> = (0..count)
        .into_par_iter()
        .with_min_len(CHUNK)
        .map(|place| {
            let mut row = list[offsets[place] as usize..offsets[place + 1] as usize].to_vec();
            row.sort_unstable();
            row.dedup();
            row
        })
        .collect();
    let mut ends = vec![0];
    let mut neighbours = Vec::with_capacity(list.len());
    for row in rows {
        neighbours.extend(row);
        ends.push(neighbours.len() as u32);
    }
    (ends, neighbours)
}
