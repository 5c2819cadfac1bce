//! Gradients of the surface's coordinates, changed face by face, and their divergence [BS08, section 3.1.1].
//!
//! A face's map T changes its rest edges e to T e. With the cotangent weights w of the face (½ cot of the opposite
//! angle, times its stiffness) the displacements d whose edges fit best minimise
//!
//! E = ½ Σ_f Σ_(ij in f) w_ij |d_j − d_i − (T_f − I) e_ij|²,
//!
//! which is the integral of |∇p' − T ∇p|². Its minimum is the Poisson equation −L d = b [BS08, equation 15] with
//! b_i = −Σ_f Σ_j w_ij (T_f − I) e_ij. Only changes of edges enter, so b is zero to the last bit at rest, and gradients
//! need not be formed.

use glam::{DMat3, DVec3};
use pliant_mesh::{Surface, SurfaceVertex, Topology, edge_lengths};
use rayon::prelude::*;

use super::face_terms::Metric;
use super::{ABSENT, Laplacian};
use crate::numerical::rows::CHUNK;

/// The faces around the solved vertices.
#[derive(Debug)]
pub(crate) struct Gradients {
    faces: Vec<Face>,
    /// The start of each solved vertex' entries of `corners`; one more at the end.
    offsets: Vec<u32>,
    /// Three times a face's place, plus the solved vertex' corner.
    corners: Vec<u32>,
    /// ½ Σ w |e|² of the rest shape.
    pub scale: f64,
}

/// A face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    /// Its number in the surface.
    pub number: u32,
    /// Its corners as the Laplacian's local vertices.
    pub locals: [u32; 3],
    /// w of the edge opposite to each corner.
    weights: [f64; 3],
    /// The rest edges from corner 0 to the corners 1 and 2, which span it.
    pub edges: [DVec3; 2],
}

/// The change of a face's two edges: (T − I) e.
pub(crate) type EdgeChanges = [DVec3; 2];

impl Gradients {
    /// The faces around the local vertices `columns` of the Laplacian, which has full rows there.
    pub fn of(
        surface: &Surface,
        topology: &Topology,
        stiffness: &[f64],
        laplacian: &Laplacian,
        columns: &[u32],
    ) -> Self {
        let mut local_of = vec![ABSENT; surface.positions.len()];
        for (local, &vertex) in laplacian.vertices().iter().enumerate() {
            local_of[vertex as usize] = local as u32;
        }
        let mut column_of = vec![ABSENT; laplacian.vertices().len()];
        for (column, &local) in columns.iter().enumerate() {
            column_of[local as usize] = column as u32;
        }
        let mut numbers: Vec<u32> = Vec::new();
        let mut is_taken = vec![false; surface.triangles.len()];
        for &local in columns {
            let vertex = SurfaceVertex(laplacian.vertices()[local as usize]);
            for face in topology.faces(vertex, &surface.triangles) {
                if !std::mem::replace(&mut is_taken[face as usize], true) {
                    numbers.push(face);
                }
            }
        }
        let metric = Metric::cotangent_area();
        let face = |&number: &u32| {
            let corners = surface.triangles[number as usize];
            let [a, b, c] = corners.map(|corner| surface.positions[corner.index()]);
            Face {
                number,
                locals: corners.map(|corner| local_of[corner.index()]),
                weights: metric.face(stiffness, corners, edge_lengths([a, b, c])).half_cotangents,
                edges: [b - a, c - a],
            }
        };
        let faces: Vec<Face> = numbers.par_iter().with_min_len(CHUNK).map(face).collect();
        let mut offsets = vec![0; columns.len() + 1];
        let solved = |face: &Face| face.locals.map(|local| column_of[local as usize]);
        for column in faces.iter().flat_map(solved).filter(|&column| column != ABSENT) {
            offsets[column as usize + 1] += 1;
        }
        for column in 0..columns.len() {
            offsets[column + 1] += offsets[column];
        }
        let mut next = offsets.clone();
        let mut entries = vec![0; offsets[columns.len()] as usize];
        for (place, face) in faces.iter().enumerate() {
            for (corner, column) in solved(face).into_iter().enumerate().filter(|(_, c)| *c != ABSENT) {
                entries[next[column as usize] as usize] = (3 * place + corner) as u32;
                next[column as usize] += 1;
            }
        }
        let scale = faces.iter().map(|face| face.square(face.edges)).sum::<f64>() * 0.5;
        Self {
            faces,
            offsets,
            corners: entries,
            scale,
        }
    }

    /// The faces with a solved corner.
    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// Fills `changes` for every face, by `change` of the face and one of its edges.
    pub fn change<F: Fn(DVec3) -> DVec3>(&self, of: impl Fn(&Face) -> F + Sync, changes: &mut Vec<EdgeChanges>) {
        changes.resize(self.faces.len(), EdgeChanges::default());
        let chunks = changes.par_chunks_mut(CHUNK).zip(self.faces.par_chunks(CHUNK));
        chunks.for_each(|(changes, faces)| {
            for (changes, face) in changes.iter_mut().zip(faces) {
                *changes = face.edges.map(of(face));
            }
        });
    }

    /// Fills `load` with `factor` b, one row for each solved vertex.
    pub fn divergence(&self, changes: &[EdgeChanges], factor: f64, load: &mut Vec<[f64; 3]>) {
        load.resize(self.offsets.len() - 1, [0.0; 3]);
        load.par_chunks_mut(CHUNK)
            .zip(self.offsets.par_chunks(CHUNK))
            .enumerate()
            .for_each(|(chunk, (load, starts))| {
                for (row, (own, &start)) in load.iter_mut().zip(starts).enumerate() {
                    let end = self.offsets[chunk * CHUNK + row + 1];
                    let mut sum = DVec3::ZERO;
                    for &entry in &self.corners[start as usize..end as usize] {
                        let (place, corner) = (entry as usize / 3, entry % 3);
                        let ([u, v], [w0, w1, w2]) = (changes[place], self.faces[place].weights);
                        // Σ_j w_ij (T − I) e_ij from this corner to the other two.
                        sum += match corner {
                            0 => u * w2 + v * w1,
                            1 => (v - u) * w0 - u * w2,
                            _ => (u - v) * w0 - v * w1,
                        };
                    }
                    *own = (sum * -factor).to_array();
                }
            });
    }

    /// The places of the faces around a solved vertex, by its row of a load.
    pub fn around(&self, column: usize) -> impl Iterator<Item = usize> + '_ {
        let own = self.offsets[column] as usize..self.offsets[column + 1] as usize;
        self.corners[own].iter().map(|&entry| entry as usize / 3)
    }

    /// E for displacements, one row for each local vertex, in units of `scale`.
    pub fn energy(&self, changes: &[EdgeChanges], d: &[[f64; 3]]) -> f64 {
        self.total(|place, face| {
            let ([u, v], [own_u, own_v]) = (face.moved(d), changes[place]);
            face.square([u - own_u, v - own_v])
        })
    }

    /// ½ Σ_f of `of`'s value for a face's place and the face, in units of `scale`.
    pub fn total(&self, of: impl Fn(usize, &Face) -> f64 + Sync) -> f64 {
        let chunk = |(chunk, faces): (usize, &[Face])| (chunk * CHUNK..).zip(faces).map(|(p, f)| of(p, f)).sum();
        let partial: Vec<f64> = self.faces.par_chunks(CHUNK).enumerate().map(chunk).collect();
        // Negative cotangents leave a rounding error of either sign if nothing is strained.
        let sum = 0.5 * partial.iter().sum::<f64>();
        let sum = if sum > 0.0 || sum.is_nan() { sum } else { 0.0 };
        if self.scale > 0.0 { sum / self.scale } else { sum }
    }
}

impl Face {
    /// The change of its two spanning edges by displacements, one row for each local vertex.
    #[inline]
    pub fn moved(&self, d: &[[f64; 3]]) -> EdgeChanges {
        let [a, b, c] = self.locals.map(|local| DVec3::from_array(d[local as usize]));
        [b - a, c - a]
    }

    /// Its two spanning edges under a linear map.
    #[inline]
    pub fn mapped(&self, map: DMat3) -> EdgeChanges {
        self.edges.map(|edge| map * edge)
    }

    /// Σ w e' eᵀ over its edges, e' being the rest edge e with displacements.
    #[inline]
    pub fn covariance(&self, d: &[[f64; 3]]) -> DMat3 {
        let ([w0, w1, w2], [a, b]) = (self.weights, self.edges);
        let [u, v] = self.moved(d);
        let outer = |to: DVec3, from: DVec3| DMat3::from_cols(to * from.x, to * from.y, to * from.z);
        outer(a + u, a * w2) + outer(b + v, b * w1) + outer(b + v - a - u, (b - a) * w0)
    }

    /// Σ w |x|² over its edges, given its two spanning edges: not negative except for rounding.
    #[inline]
    pub fn square(&self, [u, v]: [DVec3; 2]) -> f64 {
        let [w0, w1, w2] = self.weights;
        w0 * u.distance_squared(v) + w1 * v.length_squared() + w2 * u.length_squared()
    }
}
