//! The energy over spokes and rims (Chao et al. 2010): a vertex's cell is all edges of its triangles.
//!
//! E = ½ Σ_i Σ_f∋i ⅓ Σ_e∈f w_fe |e' − R_i e|², with w_fe half the cotangent opposite e in f, plain, negative ones
//! included: each triangle's inner sum is a squared norm of the 3×2 matrix Y − R_i T, where T = (e1 e2) Uᵀ, Y the same of
//! the deformed edges and UᵀU the triangle's 2×2 form, so nothing is ever negative. It is evaluated just so, as a sum
//! of squares: near a rigid motion it keeps its digits, where Σ|e'|² − 2 tr(RᵀS) would cancel. With the ⅓ the
//! majorising quadratic's matrix is the Laplacian itself.
//!
//! Stiffness is in w_fe: a face's by the mean of its corners.

use glam::{DMat3, DVec3};
use pliant_mesh::{Surface, edge_lengths};
use rayon::prelude::*;

use super::domain::Domain;
use super::shape::{Scratch, Shape, fit_cells};
use crate::operators::CHUNK;
use crate::operators::face_terms::Metric;

/// The energy's terms on a domain.
#[derive(Debug)]
pub(crate) struct Rims {
    faces: Vec<Face>,
    /// Of each cell: where its entries of `corners` start.
    offsets: Vec<u32>,
    /// 3 · face + corner.
    corners: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Face {
    corners: [u32; 3],
    /// U's entries 11, 12, 22: the upper triangle.
    form: [f64; 3],
    /// T's columns.
    rest: [DVec3; 2],
}

impl Face {
    /// Y − T's columns: the form of the edges' displacements.
    #[inline]
    fn strained(&self, displacements: &[DVec3]) -> [DVec3; 2] {
        let [a, b, c] = self.corners.map(|corner| displacements[corner as usize]);
        let (e1, e2) = (b - a, c - a);
        [e1 * self.form[0] + e2 * self.form[1], e2 * self.form[2]]
    }
}

impl Rims {
    /// The terms of `domain`'s faces.
    pub fn new(surface: &Surface, stiffness: &[f64], domain: &Domain) -> Self {
        let metric = Metric::cotangent_area();
        let faces: Vec<Face> = domain
            .faces
            .par_iter()
            .with_min_len(CHUNK)
            .map(|&face| {
                let corners = surface.triangles[face as usize];
                let [a, b, c] = corners.map(|corner| surface.positions[corner.index()]);
                let [h0, h1, h2] = metric.face(stiffness, corners, edge_lengths([a, b, c])).half_cotangents;
                let (e1, e2) = (b - a, c - a);
                // h2|e1|² + h1|e2|² + h0|e2 − e1|² = |U (e1 e2)ᵀ|².
                let u11 = (h2 + h0).max(0.0).sqrt();
                let u12 = if u11 > 0.0 { -h0 / u11 } else { 0.0 };
                let u22 = (h1 + h0 - u12 * u12).max(0.0).sqrt();
                Face {
                    corners: corners.map(|corner| domain.local_of[corner.index()]),
                    form: [u11, u12, u22],
                    rest: [e1 * u11 + e2 * u12, e2 * u22],
                }
            })
            .collect();
        let mut offsets = vec![0; domain.cell_count + 1];
        let of_cells = |face: &Face| {
            face.corners
                .into_iter()
                .filter(|&corner| (corner as usize) < domain.cell_count)
        };
        for corner in faces.iter().flat_map(of_cells) {
            offsets[corner as usize + 1] += 1;
        }
        for cell in 0..domain.cell_count {
            offsets[cell + 1] += offsets[cell];
        }
        let mut next = offsets.clone();
        let mut corners = vec![0; offsets[domain.cell_count] as usize];
        for (number, face) in faces.iter().enumerate() {
            for (corner, &vertex) in face.corners.iter().enumerate() {
                if (vertex as usize) < domain.cell_count {
                    corners[next[vertex as usize] as usize] = (3 * number + corner) as u32;
                    next[vertex as usize] += 1;
                }
            }
        }
        Self {
            faces,
            offsets,
            corners,
        }
    }

    fn around(&self, cell: usize) -> &[u32] {
        &self.corners[self.offsets[cell] as usize..self.offsets[cell + 1] as usize]
    }

    /// ½ Σ_f Σ_e w_fe |e|².
    pub fn scale(&self) -> f64 {
        let square = |face: &Face| face.rest[0].length_squared() + face.rest[1].length_squared();
        0.5 * self.faces.iter().map(square).sum::<f64>()
    }

    /// As [`super::shape::Energy::evaluate`].
    pub fn evaluate(&self, shape: &mut Shape, scratch: &mut Scratch) {
        let Shape {
            displacements,
            rotations,
            gradient,
            energy,
        } = shape;
        let Scratch {
            turns,
            covariances,
            pulls,
        } = scratch;
        covariances.resize(self.faces.len(), DMat3::ZERO);
        covariances
            .par_chunks_mut(CHUNK)
            .zip(self.faces.par_chunks(CHUNK))
            .for_each(|(covariances, faces)| {
                for (covariance, face) in covariances.iter_mut().zip(faces) {
                    *covariance = face.covariance(displacements);
                }
            });
        fit_cells(rotations, turns, |cell| {
            let mut sum = DMat3::ZERO;
            for &corner in self.around(cell) {
                sum += covariances[corner as usize / 3];
            }
            sum
        });
        pulls.resize(self.faces.len(), [DVec3::ZERO; 2]);
        let partial: Vec<f64> = pulls
            .par_chunks_mut(CHUNK)
            .zip(self.faces.par_chunks(CHUNK))
            .map(|(pulls, faces)| {
                let mut sum = 0.0;
                for (pull, face) in pulls.iter_mut().zip(faces) {
                    let (edges, square) = face.pull(displacements, turns);
                    *pull = edges;
                    sum += square;
                }
                sum
            })
            .collect();
        *energy = partial.iter().sum::<f64>() / 6.0;
        gradient
            .par_iter_mut()
            .with_min_len(CHUNK)
            .enumerate()
            .for_each(|(vertex, gradient)| {
                let mut sum = DVec3::ZERO;
                for &corner in self.around(vertex) {
                    let [first, second] = pulls[corner as usize / 3];
                    match corner % 3 {
                        0 => sum -= first + second,
                        1 => sum += first,
                        _ => sum += second,
                    }
                }
                *gradient = (sum / 3.0).to_array();
            });
    }
}

impl Face {
    /// Y Tᵀ.
    #[inline]
    fn covariance(&self, displacements: &[DVec3]) -> DMat3 {
        let [d1, d2] = self.strained(displacements);
        let [t1, t2] = self.rest;
        let (y1, y2) = (t1 + d1, t2 + d2);
        DMat3::from_cols(y1 * t1.x + y2 * t2.x, y1 * t1.y + y2 * t2.y, y1 * t1.z + y2 * t2.z)
    }

    /// Σ (Y − R_i T) U over the corners with a cell (and so a turn), and Σ |Y − R_i T|².
    #[inline]
    fn pull(&self, displacements: &[DVec3], turns: &[DMat3]) -> ([DVec3; 2], f64) {
        let [d1, d2] = self.strained(displacements);
        let [t1, t2] = self.rest;
        let (y1, y2) = (t1 + d1, t2 + d2);
        let (mut g1, mut g2, mut square) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for &corner in &self.corners {
            if let Some(turn) = turns.get(corner as usize) {
                let (r1, r2) = (y1 - *turn * t1, y2 - *turn * t2);
                g1 += r1;
                g2 += r2;
                square += r1.length_squared() + r2.length_squared();
            }
        }
        let [u11, u12, u22] = self.form;
        ([g1 * u11, g1 * u12 + g2 * u22], square)
    }
}
