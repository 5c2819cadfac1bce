//! Displacement volumes: the prism between each triangle of the base and that of the surface keeps its volume [BK03].
//!
//! The frame begins with normal displacements. Their prisms' volumes V are off by some percent to a quarter, since the
//! base's triangles and their neighbours' normals have moved against each other. Gauss–Newton corrections x then
//! minimise
//!
//! Σ_f (V_f + ∇V_f · x − V⁰_f)² / A_f + λ Σ_f A_f Σ_edges |x_i − x_j|²,
//!
//! with A_f the surface's area at rest: the first term is the squared error of the mean height, integrated over the
//! surface, the second keeps neighbours together where the volumes leave the vertices free, as in sliding along a
//! smooth surface. There are twice as many prisms as vertices, but each vertex has three coordinates, so the volumes can
//! be met. Conjugate gradients find a correction; nothing is factored, because the gradients change in each frame.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::base::Base;
use super::faces::Faces;
use super::normals::NormalDisplacements;
use super::prism::{gradient, volume};
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::{Field, add, dot};
use crate::region::boundary_problem::BoundaryProblem;

/// The prisms over the base's triangles, and the displacements that a frame begins with.
#[derive(Debug)]
pub(crate) struct Volumes {
    normals: NormalDisplacements,
    /// The most corrections of a frame.
    corrections: u32,
    /// The prisms' volumes at rest.
    volumes: Vec<f64>,
    /// The rest area of the surface's triangle, and its inverse.
    areas: Vec<[f64; 2]>,
    /// A frame's sum of |V − V⁰| that is small enough.
    enough: f64,
    /// Whether the corrections move the local vertex.
    is_free: Vec<bool>,
    room: Room,
}

/// Buffers kept from frame to frame, so that no frame allocates them.
#[derive(Debug, Default)]
struct Room {
    /// The surface's points at each local vertex, and the same before the last correction.
    tops: Vec<DVec3>,
    before: Vec<DVec3>,
    /// The rows' points by normal displacements.
    points: Vec<DVec3>,
    lacks: Vec<f64>,
    gradients: Vec<[DVec3; 3]>,
    /// ∇V · x / A of each prism.
    changes: Vec<f64>,
    inverse_blocks: Vec<DMat3>,
    correction: Field,
    residual: Field,
    conditioned: Field,
    direction: Field,
    image: Field,
}

/// λ: with 0.01 the volumes are no nearer after three corrections and some triangles are stretched more.
const EVENNESS: f64 = 0.1;

/// The most conjugate gradient steps of a correction: 40 leave the same error after the next one.
const STEPS: usize = 15;

/// Conjugate gradients end when the residual has fallen to this share of its length.
const RESIDUAL: f64 = 1e-3;

/// Corrections end when the sum of |V − V⁰| is below this share of the sum of |V⁰| ..
const TOLERANCE: f64 = 1e-3;

/// .. or below rounding: this share of the surface's area times the size of the bending part ..
const ROUNDING: f64 = 1e-12;

/// .. or with a correction that leaves more than this share of the sum.
const LEFT: f64 = 0.8;

impl Volumes {
    /// The prisms of the base's faces.
    pub fn of(base: &Base, corrections: u32, problem: &BoundaryProblem<'_>) -> Self {
        let normals = NormalDisplacements::of(base, problem);
        let patch = &base.patch;
        let mut is_free = vec![false; patch.vertices.len()];
        let mut surface = patch.rest.clone();
        for (row, &local) in patch.rows.iter().enumerate() {
            is_free[local as usize] = base.is_faired[row];
            surface[local as usize] += base.offsets[row];
        }
        let mut tops = Vec::new();
        put(base, &patch.rest, &normals.at_rest, &mut tops);
        let corners = normals.faces.corners.par_iter().with_min_len(CHUNK);
        let volumes: Vec<f64> = corners.map(|corners| volume_of(*corners, &patch.rest, &tops)).collect();
        let area = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| surface[corner as usize]);
            (b - a).cross(c - a).length() * 0.5
        };
        let areas: Vec<f64> = normals.faces.corners.iter().map(area).collect();
        let whole: f64 = areas.iter().sum();
        // A sliver's error of height counts no more than that of a triangle of this area.
        let least = 1e-3 * whole / areas.len().max(1) as f64;
        let total: f64 = volumes.iter().map(|volume| volume.abs()).sum();
        Self {
            enough: TOLERANCE * total + ROUNDING * patch.size * whole,
            areas: areas
                .iter()
                .map(|area| [area.max(least), area.max(least).recip()])
                .collect(),
            room: Room {
                tops,
                ..Room::default()
            },
            normals,
            corrections,
            volumes,
            is_free,
        }
    }

    /// The base's triangles.
    pub fn faces(&self) -> &Faces {
        &self.normals.faces
    }

    /// The motion of a row's point from rest in the last frame.
    #[inline]
    pub fn change(&self, base: &Base, row: usize) -> DVec3 {
        self.room.tops[base.patch.rows[row] as usize] - self.normals.at_rest[row]
    }

    /// Displaces the bent base.
    pub fn frame(&mut self, base: &Base, posed: &[DVec3], turns: &[DMat3]) {
        self.normals.bend(posed);
        let mut room = std::mem::take(&mut self.room);
        let rows = (0..base.patch.rows.len()).into_par_iter().with_min_len(CHUNK);
        rows.map(|row| self.normals.point(base, row, posed, turns))
            .collect_into_vec(&mut room.points);
        put(base, posed, &room.points, &mut room.tops);
        let mut error = self.measure(posed, &mut room);
        for _ in 0..self.corrections {
            if error <= self.enough {
                break;
            }
            self.correct(posed, &mut room);
            room.before.clone_from(&room.tops);
            for (top, [x, y, z]) in room.tops.iter_mut().zip(&room.correction) {
                *top += DVec3::new(*x, *y, *z);
            }
            let next = self.measure(posed, &mut room);
            if next.is_nan() || next >= error {
                room.tops.clone_from(&room.before);
                break;
            }
            let is_last = next > LEFT * error;
            error = next;
            if is_last {
                break;
            }
        }
        self.room = room;
    }

    /// Fills in what each prism lacks; returns the sum of the lacks' sizes.
    fn measure(&self, posed: &[DVec3], room: &mut Room) -> f64 {
        let Room { tops, lacks, .. } = room;
        let corners = self.faces().corners.par_iter().zip(&self.volumes).with_min_len(CHUNK);
        corners
            .map(|(corners, volume)| volume - volume_of(*corners, posed, tops))
            .collect_into_vec(lacks);
        let partial: Vec<f64> = lacks
            .par_chunks(CHUNK)
            .map(|lacks| lacks.iter().map(|lack| lack.abs()).sum())
            .collect();
        partial.iter().sum()
    }

    /// Finds the correction of all local vertices by conjugate gradients with the vertices' own blocks as
    /// preconditioner.
    fn correct(&self, posed: &[DVec3], room: &mut Room) {
        let faces = self.faces();
        let corners = faces.corners.par_iter().with_min_len(CHUNK);
        corners
            .map(|corners| {
                let of = |points: &[DVec3]| corners.map(|corner| points[corner as usize]);
                gradient(of(posed), of(&room.tops))
            })
            .collect_into_vec(&mut room.gradients);
        let blocks = (0..posed.len()).into_par_iter().with_min_len(CHUNK);
        blocks
            .map(|local| self.inverse_block(local, &room.gradients))
            .collect_into_vec(&mut room.inverse_blocks);
        let weighted = room.lacks.par_iter().zip(&self.areas).with_min_len(CHUNK);
        weighted
            .map(|(lack, [_, inverse])| lack * inverse)
            .collect_into_vec(&mut room.changes);
        self.gather(&room.gradients, &room.changes, None, &mut room.residual);
        room.correction.clear();
        room.correction.resize(posed.len(), [0.0; 3]);
        condition(&room.inverse_blocks, &room.residual, &mut room.conditioned);
        room.direction.clone_from(&room.conditioned);
        let mut square = dot(&room.residual, &room.conditioned);
        let least = RESIDUAL * RESIDUAL * square;
        for _ in 0..STEPS {
            if square <= least {
                break;
            }
            let changes = faces.corners.par_iter().zip(&room.gradients).zip(&self.areas);
            changes
                .with_min_len(CHUNK)
                .map(|((corners, gradients), [_, inverse])| {
                    let along = |k: usize| gradients[k].dot(DVec3::from_array(room.direction[corners[k] as usize]));
                    (along(0) + along(1) + along(2)) * inverse
                })
                .collect_into_vec(&mut room.changes);
            self.gather(&room.gradients, &room.changes, Some(&room.direction), &mut room.image);
            let step = square / dot(&room.direction, &room.image);
            if !step.is_finite() {
                break;
            }
            add(&mut room.correction, step, &room.direction);
            add(&mut room.residual, -step, &room.image);
            condition(&room.inverse_blocks, &room.residual, &mut room.conditioned);
            let next = dot(&room.residual, &room.conditioned);
            let share = next / square;
            square = next;
            let rows = room.direction.par_iter_mut().zip(&room.conditioned).with_min_len(CHUNK);
            rows.for_each(|(direction, conditioned)| {
                *direction = std::array::from_fn(|k| conditioned[k] + share * direction[k]);
            });
        }
    }

    /// Fills in Σ_f ∇V_f c_f at each free vertex, c being `changes`, and with a field x also λ Σ_f A_f Σ_j (x_i − x_j).
    fn gather(&self, gradients: &[[DVec3; 3]], changes: &[f64], x: Option<&Field>, out: &mut Field) {
        let faces = self.faces();
        let at = |local: usize| {
            if !self.is_free[local] {
                return [0.0; 3];
            }
            let mut sum = DVec3::ZERO;
            for &face in faces.around(local) {
                let face = face as usize;
                let corners = faces.corners[face];
                for (corner, gradient) in corners.iter().zip(&gradients[face]) {
                    if *corner as usize == local {
                        sum += *gradient * changes[face];
                    }
                }
                if let Some(x) = x {
                    let [a, b, c] = corners.map(|corner| DVec3::from_array(x[corner as usize]));
                    let apart = DVec3::from_array(x[local]) * 3.0 - (a + b + c);
                    sum += apart * (EVENNESS * self.areas[face][0]);
                }
            }
            sum.to_array()
        };
        let locals = (0..self.is_free.len()).into_par_iter().with_min_len(CHUNK);
        locals.map(at).collect_into_vec(out);
    }

    /// The inverse of a vertex' own block of the system.
    fn inverse_block(&self, local: usize, gradients: &[[DVec3; 3]]) -> DMat3 {
        if !self.is_free[local] {
            return DMat3::ZERO;
        }
        let faces = self.faces();
        let mut block = DMat3::ZERO;
        for &face in faces.around(local) {
            let face = face as usize;
            let [area, inverse] = self.areas[face];
            block += DMat3::from_diagonal(DVec3::splat(2.0 * EVENNESS * area));
            for (corner, gradient) in faces.corners[face].iter().zip(&gradients[face]) {
                if *corner as usize == local {
                    let scaled = *gradient * inverse;
                    block += DMat3::from_cols(*gradient * scaled.x, *gradient * scaled.y, *gradient * scaled.z);
                }
            }
        }
        block.inverse()
    }
}

/// Fills in the surface's points at each local vertex: the rows' own `points`, the base's elsewhere.
fn put(base: &Base, posed: &[DVec3], points: &[DVec3], tops: &mut Vec<DVec3>) {
    tops.clear();
    tops.extend_from_slice(posed);
    for (&local, point) in base.patch.rows.iter().zip(points) {
        tops[local as usize] = *point;
    }
}

fn volume_of(corners: [u32; 3], posed: &[DVec3], tops: &[DVec3]) -> f64 {
    let of = |points: &[DVec3]| corners.map(|corner| points[corner as usize]);
    volume(of(posed), of(tops))
}

/// Multiplies each row by its block.
fn condition(blocks: &[DMat3], rows: &Field, out: &mut Field) {
    let pairs = blocks.par_iter().zip(rows).with_min_len(CHUNK);
    pairs
        .map(|(block, row)| (*block * DVec3::from_array(*row)).to_array())
        .collect_into_vec(out);
}
