//! The couplings between prisms, seen from each solved one, and their weights.
//!
//! E = ½ Σ w_ij ∫∫ |T_i f − T_j f|² over the shared quads, w_ij = |e|² / (|F_i| + |F_j|) times the painted stiffness,
//! which is the mean of the two triangles', each the mean of its vertices'.

use glam::{DMat3, DVec3};
use pliant_mesh::{Surface, SurfaceVertex, vertex_normals};
use rayon::prelude::*;

use super::edges::{Edges, area, sides as sides_of};
use super::prisms::{NONE, Prisms};
use super::quad::Quad;
use crate::numerical::rows::CHUNK;

/// The least weight of a coupling: even an edge without length holds its prisms together.
const WEIGHT_FLOOR: f64 = 1e-9;

/// The weight of a pin, as a multiple of that of an equilateral triangle's edge: with 1 the surroundings of a handle of
/// one vertex would lag behind by a tenth of its displacement.
const PIN_WEIGHT: f64 = 1e3;

/// The joints of the solved prisms.
#[derive(Debug)]
pub(crate) struct Joints {
    /// The start of each solved prism's `sides`.
    offsets: Vec<u32>,
    sides: Vec<Side>,
    /// The rest centre of each body, relative to the origin: prisms', then the fixed ground's and the handles'.
    pub centres: Vec<DVec3>,
    /// The solved prisms by rising triangle.
    pub order: Vec<u32>,
    /// The sum of the solved prisms' areas.
    pub area: f64,
    /// The ends of the supernodes of prisms; empty if each prism is its own.
    pub block_ends: Vec<u32>,
}

/// One joint seen from one of its prisms.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side {
    /// The other body: a solved prism, or a ground.
    pub other: u32,
    /// w.
    pub weight: f64,
    /// The quad's middle relative to this prism's centre.
    pub own_arm: DVec3,
    /// The quad's middle relative to the other's centre.
    pub other_arm: DVec3,
    /// C.
    pub spread: DMat3,
}

/// The data for making joints.
pub(crate) struct Material<'a> {
    pub edges: &'a Edges<'a>,
    /// One normal per surface vertex.
    pub stiffness: &'a [f64],
    /// The prisms' height, in world units.
    pub thickness: f64,
    pub world_origin: DVec3,
    /// The grounds' centres, in world units.
    pub world_grounds: &'a [DVec3],
}

impl Joints {
    /// The ends of the supernodes of a matrix with this many columns per prism.
    pub fn column_ends(&self, per_prism: usize) -> Vec<u32> {
        if self.block_ends.is_empty() {
            return (1..=self.count()).map(|end| (per_prism * end) as u32).collect();
        }
        self.block_ends.iter().map(|end| per_prism as u32 * end).collect()
    }

    /// The joints of `prisms`, in their order.
    pub fn of(prisms: &Prisms, material: &Material) -> Self {
        let Edges { surface, topology, .. } = *material.edges;
        let world_centre = |face: u32| {
            let [a, b, c] = surface.corners(face as usize);
            (a - material.world_origin) + ((b - a) + (c - a)) / 3.0
        };
        let mut centres: Vec<DVec3> = prisms.faces.par_iter().map(|&face| world_centre(face)).collect();
        centres.extend(
            material
                .world_grounds
                .iter()
                .map(|&ground| ground - material.world_origin),
        );
        let mut normals = Vec::new();
        vertex_normals(&surface.triangles, topology, &surface.positions, &mut normals);
        let rows: Vec<Vec<Side>> = prisms
            .faces
            .par_iter()
            .with_min_len(CHUNK)
            .enumerate()
            .map(|(prism, &face)| sides(prisms, material, &normals, &centres, prism, face))
            .collect();
        let mut offsets = vec![0];
        let mut sides = Vec::with_capacity(rows.iter().map(Vec::len).sum());
        for row in rows {
            sides.extend(row);
            offsets.push(sides.len() as u32);
        }
        let mut order: Vec<u32> = (0..prisms.count() as u32).collect();
        order.sort_unstable_by_key(|&prism| prisms.faces[prism as usize]);
        let mut joints = Self {
            offsets,
            sides,
            centres,
            order,
            block_ends: Vec::new(),
            area: prisms.faces.iter().map(|&face| area(surface, face)).sum(),
        };
        joints.pin(prisms, material);
        joints
    }

    /// The joints of bodies around these centres, which are followed by those of the grounds, in an order of
    /// elimination whose supernodes end at `block_ends`. `size` is the energy's unit.
    pub fn of_rows(rows: Vec<Vec<Side>>, centres: Vec<DVec3>, size: f64, block_ends: Vec<u32>) -> Self {
        let mut joints = Self {
            offsets: vec![0],
            sides: Vec::new(),
            centres,
            order: (0..rows.len() as u32).collect(),
            area: size,
            block_ends,
        };
        for row in rows {
            joints.sides.extend(row);
            joints.offsets.push(joints.sides.len() as u32);
        }
        joints
    }

    /// The number of solved prisms.
    pub fn count(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The joints of one prism.
    pub fn sides(&self, prism: usize) -> &[Side] {
        &self.sides[self.offsets[prism] as usize..self.offsets[prism + 1] as usize]
    }

    /// The same joints between cells of bodies, each of which moves as one; those within a cell are dropped.
    pub fn of_cells(&self, cell_of: &[u32]) -> Self {
        let count = self.count();
        let cell_count = cell_of.iter().max().map_or(0, |&last| last as usize + 1);
        let mut members = vec![Vec::new(); cell_count];
        for (body, &cell) in cell_of.iter().enumerate() {
            members[cell as usize].push(body);
        }
        let mean = |bodies: &Vec<usize>| {
            bodies.iter().map(|&body| self.centres[body]).sum::<DVec3>() / bodies.len().max(1) as f64
        };
        let mut coarse = Self {
            offsets: vec![0],
            sides: Vec::new(),
            centres: members.iter().map(mean).collect(),
            order: Vec::new(),
            block_ends: Vec::new(),
            area: self.area,
        };
        coarse.centres.extend_from_slice(&self.centres[count..]);
        let cell_or_ground = |other: usize| {
            if other < count {
                cell_of[other] as usize
            } else {
                cell_count + other - count
            }
        };
        for (cell, bodies) in members.iter().enumerate() {
            for &body in bodies {
                for side in self.sides(body) {
                    let other = cell_or_ground(side.other as usize);
                    if other != cell {
                        let middle = self.centres[body] + side.own_arm;
                        coarse.sides.push(Side {
                            other: other as u32,
                            own_arm: middle - coarse.centres[cell],
                            other_arm: middle - coarse.centres[other],
                            ..*side
                        });
                    }
                }
            }
            coarse.offsets.push(coarse.sides.len() as u32);
        }
        coarse.order = (0..cell_count as u32).collect();
        coarse
    }

    /// The other solved bodies joined to each, each once, as compressed rows.
    pub fn graph(&self) -> (Vec<u32>, Vec<u32>) {
        let (mut offsets, mut list) = (vec![0], Vec::new());
        let mut seen = vec![NONE; self.count()];
        for body in 0..self.count() {
            for side in self.sides(body) {
                if seen.get(side.other as usize).is_some_and(|&by| by != body as u32) {
                    seen[side.other as usize] = body as u32;
                    list.push(side.other);
                }
            }
            offsets.push(list.len() as u32);
        }
        (offsets, list)
    }

    /// The bodies in an order that keeps neighbours close.
    pub fn walk(&self) -> &[u32] {
        &self.order
    }

    fn pin(&mut self, prisms: &Prisms, material: &Material) {
        if prisms.pins.is_empty() {
            return;
        }
        let mut extra = vec![Vec::new(); self.count()];
        for pin in &prisms.pins {
            let prism = prisms.body_of[pin.face as usize] as usize;
            let other = (self.count() as u32) + pin.ground;
            let point = material.edges.surface.positions[pin.vertex as usize] - material.world_origin;
            let ball = Quad::around(point, material.thickness);
            extra[prism].push(Side {
                other,
                weight: PIN_WEIGHT * stiffness(material, pin.face),
                own_arm: ball.middle - self.centres[prism],
                other_arm: ball.middle - self.centres[other as usize],
                spread: ball.spread,
            });
        }
        let mut sides = Vec::with_capacity(self.sides.len() + prisms.pins.len());
        let mut offsets = vec![0];
        for (prism, extra) in extra.into_iter().enumerate() {
            sides.extend_from_slice(self.sides(prism));
            sides.extend(extra);
            offsets.push(sides.len() as u32);
        }
        (self.sides, self.offsets) = (sides, offsets);
    }
}

fn sides(
    prisms: &Prisms,
    material: &Material,
    normals: &[DVec3],
    centres: &[DVec3],
    prism: usize,
    face: u32,
) -> Vec<Side> {
    let surface = material.edges.surface;
    let mut sides = Vec::with_capacity(3);
    for [a, b] in sides_of(surface.triangles[face as usize]) {
        let at = |v: SurfaceVertex| surface.positions[v.index()] - material.world_origin;
        let across = material.edges.across(face, [a, b]);
        let joints = across.clone().count();
        for other in across {
            let body = prisms.body_of[other as usize];
            // Both of a joint's prisms must see the same quad, to the last bit.
            let [a, b] = if a < b { [a, b] } else { [b, a] };
            let face_normal = normal(surface, face.min(other)) + normal(surface, face.max(other));
            let quad = Quad::over(
                at(a),
                at(b),
                [normals[a.index()], normals[b.index()]],
                face_normal,
                material.thickness,
            );
            let (one, two) = (face.min(other), face.max(other));
            let crowded_areas = material.edges.crowded_areas([one, two], [a, b]);
            let joints = if crowded_areas.is_some() { 1 } else { joints };
            let areas = crowded_areas.unwrap_or_else(|| area(surface, one) + area(surface, two));
            let share = at(a).distance_squared(at(b)) / areas.max(f64::MIN_POSITIVE);
            let stiffness = 0.5 * (stiffness(material, one) + stiffness(material, two));
            sides.push(Side {
                other: body,
                weight: share.max(WEIGHT_FLOOR) * stiffness / joints as f64,
                own_arm: quad.middle - centres[prism],
                other_arm: quad.middle - centres[body as usize],
                spread: quad.spread,
            });
        }
    }
    sides
}

/// Twice the area times the unit normal.
fn normal(surface: &Surface, face: u32) -> DVec3 {
    let [a, b, c] = surface.corners(face as usize);
    (b - a).cross(c - a)
}

fn stiffness(material: &Material, face: u32) -> f64 {
    let corners = material.edges.surface.triangles[face as usize];
    corners
        .iter()
        .map(|corner| material.stiffness[corner.index()])
        .sum::<f64>()
        / 3.0
}
