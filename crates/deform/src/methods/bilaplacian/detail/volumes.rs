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
//! be met. A few conjugate gradient steps find a correction; nothing is factored, because the gradients change in each
//! frame. A product is a pass over the faces, which reads the field at their corners, and one over the vertices, which
//! reads four numbers and a gradient of each face around them.

use glam::{DMat3, DVec3, Mat3, Vec3};
use rayon::prelude::*;

use super::base::Base;
use super::faces::Faces;
use super::normals::NormalDisplacements;
use super::prism::{gradient, volume};
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::CHUNKS_A_TASK;
use crate::region::boundary_problem::BoundaryProblem;

/// The prisms over the base's triangles, and the displacements that a frame begins with.
#[derive(Debug)]
pub(crate) struct Volumes {
    normals: NormalDisplacements,
    /// The most corrections of a frame.
    corrections: u32,
    /// The prisms' volumes at rest.
    volumes: Vec<f64>,
    /// √A of the surface's triangles.
    root_areas: Vec<f64>,
    /// 3 λ Σ A over the faces around each local vertex.
    evenness: Vec<f64>,
    /// The unit of the vertices' blocks, whose inverses are in single precision: the triangles' mean area.
    block_unit: f64,
    /// A frame's sum of |V − V⁰| that is small enough.
    enough: f64,
    /// Whether the corrections move the local vertex.
    is_free: Vec<bool>,
    scratch: Scratch,
}

/// Buffers kept from frame to frame, so that no frame allocates them.
#[derive(Debug, Default)]
struct Scratch {
    /// The surface's points at each local vertex, and the same before the last correction.
    tops: Vec<DVec3>,
    before: Vec<DVec3>,
    /// The rows' points by normal displacements.
    points: Vec<DVec3>,
    lacks: Vec<f64>,
    /// ∇V / √A of each prism by its corners. **f32**: they give corrections alone, whose result is measured in f64.
    gradients: Vec<[Vec3; 3]>,
    /// Four numbers for each prism, which the vertices around it read: ∇V · x / √A, and λ A Σ x over its corners.
    sums: Vec<[f64; 4]>,
    steps: Steps,
}

/// The fields of the conjugate gradient steps, a vector for each local vertex.
#[derive(Debug, Default)]
struct Steps {
    /// The inverse of each vertex' own block of the system, the preconditioner. **f32**: it only shapes the steps.
    inverse_blocks: Vec<Mat3>,
    correction: Vec<DVec3>,
    residual: Vec<DVec3>,
    conditioned: Vec<DVec3>,
    direction: Vec<DVec3>,
    image: Vec<DVec3>,
}

/// λ: with 0.01 the volumes are no nearer after three corrections and some triangles are stretched more.
const EVENNESS: f64 = 0.1;

/// The most conjugate gradient steps of a correction: 15 and 40 leave the same error after the next one.
const STEPS: usize = 6;

/// Conjugate gradients end when the residual has fallen to this share of its length.
const RESIDUAL: f64 = 1e-3;

/// Corrections end when the sum of |V − V⁰| is below this share of the sum of |V⁰| ..
const TOLERANCE: f64 = 1e-3;

/// .. or below rounding: this share of the surface's area times the size of the bending part ..
const ROUNDING: f64 = 1e-12;

/// .. or with a correction that leaves more than this share of the sum.
const LEFT: f64 = 0.6;

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
        let root_areas: Vec<f64> = areas.iter().map(|area| area.max(least).sqrt()).collect();
        let around = |local: usize| {
            normals
                .faces
                .around(local)
                .map(|face| root_areas[face as usize].powi(2))
        };
        let evenness = (0..patch.vertices.len()).map(|local| 3.0 * EVENNESS * around(local).sum::<f64>());
        Self {
            enough: TOLERANCE * total + ROUNDING * patch.size * whole,
            evenness: evenness.collect(),
            block_unit: whole / root_areas.len().max(1) as f64,
            root_areas,
            scratch: Scratch {
                tops,
                ..Scratch::default()
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
        self.scratch.tops[base.patch.rows[row] as usize] - self.normals.at_rest[row]
    }

    /// Displaces the bent base.
    pub fn frame(&mut self, base: &Base, posed: &[DVec3], turns: &[DMat3]) {
        self.normals.bend(posed);
        let mut scratch = std::mem::take(&mut self.scratch);
        let rows = (0..base.patch.rows.len()).into_par_iter().with_min_len(CHUNK);
        rows.map(|row| self.normals.point(base, row, posed, turns))
            .collect_into_vec(&mut scratch.points);
        put(base, posed, &scratch.points, &mut scratch.tops);
        let mut error = self.measure(posed, &mut scratch);
        for _ in 0..self.corrections {
            if error <= self.enough {
                break;
            }
            self.correct(posed, &mut scratch);
            scratch.before.clone_from(&scratch.tops);
            for (top, correction) in scratch.tops.iter_mut().zip(&scratch.steps.correction) {
                *top += *correction;
            }
            let next = self.measure(posed, &mut scratch);
            if next.is_nan() || next >= error {
                scratch.tops.clone_from(&scratch.before);
                break;
            }
            let is_last = next > LEFT * error;
            error = next;
            if is_last {
                break;
            }
        }
        self.scratch = scratch;
    }

    /// Fills in what each prism lacks; returns the sum of the lacks' sizes.
    fn measure(&self, posed: &[DVec3], scratch: &mut Scratch) -> f64 {
        let Scratch { tops, lacks, .. } = scratch;
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
    fn correct(&self, posed: &[DVec3], scratch: &mut Scratch) {
        self.differentiate(posed, scratch);
        let lacking = scratch.lacks.par_iter().zip(&self.root_areas).with_min_len(CHUNK);
        lacking
            .map(|(lack, root)| [lack / root, 0.0, 0.0, 0.0])
            .collect_into_vec(&mut scratch.sums);
        let (gradients, steps) = (&scratch.gradients, &mut scratch.steps);
        self.gather(gradients, &scratch.sums, None, &mut steps.residual);
        for field in [&mut steps.correction, &mut steps.direction, &mut steps.image] {
            field.clear();
            field.resize(posed.len(), DVec3::ZERO);
        }
        steps.conditioned.resize(posed.len(), DVec3::ZERO);
        let mut square = steps.walk(0.0);
        let least = RESIDUAL * RESIDUAL * square;
        let mut share = 0.0;
        for _ in 0..STEPS {
            if square <= least {
                break;
            }
            steps.turn(share);
            self.sum(gradients, &steps.direction, &mut scratch.sums);
            let along = self.gather(gradients, &scratch.sums, Some(&steps.direction), &mut steps.image);
            let length = square / along;
            if !length.is_finite() {
                break;
            }
            let next = steps.walk(length);
            share = next / square;
            square = next;
        }
    }

    /// Fills in the prisms' gradients, and the inverse of each vertex' own block of the system.
    fn differentiate(&self, posed: &[DVec3], scratch: &mut Scratch) {
        let tops = &scratch.tops;
        let corners = self.faces().corners.par_iter().zip(&self.root_areas);
        corners
            .with_min_len(CHUNK)
            .map(|(corners, root)| {
                let of = |points: &[DVec3]| corners.map(|corner| points[corner as usize]);
                gradient(of(posed), of(tops)).map(|gradient| (gradient / *root).as_vec3())
            })
            .collect_into_vec(&mut scratch.gradients);
        let slopes = scratch.gradients.as_flattened();
        let inverse = |local: usize| {
            if !self.is_free[local] {
                return Mat3::ZERO;
            }
            let mut block = DMat3::from_diagonal(DVec3::splat(2.0 / 3.0 * self.evenness[local]));
            for &slot in self.faces().slots(local) {
                let slope = slopes[slot as usize].as_dvec3();
                block += DMat3::from_cols(slope * slope.x, slope * slope.y, slope * slope.z);
            }
            (block * self.block_unit.recip()).inverse().as_mat3()
        };
        let locals = (0..posed.len()).into_par_iter().with_min_len(CHUNK);
        locals.map(inverse).collect_into_vec(&mut scratch.steps.inverse_blocks);
    }

    /// Fills in the sums of a field x over the corners of each prism.
    fn sum(&self, gradients: &[[Vec3; 3]], x: &[DVec3], sums: &mut Vec<[f64; 4]>) {
        let prisms = self.faces().corners.par_iter().zip(gradients).zip(&self.root_areas);
        prisms
            .with_min_len(CHUNK)
            .map(|((corners, gradients), root)| {
                let x = corners.map(|corner| x[corner as usize]);
                let along = |k: usize| gradients[k].as_dvec3().dot(x[k]);
                let even = (x[0] + x[1] + x[2]) * (EVENNESS * root * root);
                [along(0) + along(1) + along(2), even.x, even.y, even.z]
            })
            .collect_into_vec(sums);
    }

    /// Fills in Σ_f ∇V_f c_f / √A_f at each free vertex, c being the first of the prisms' `sums`, and with a field x
    /// also λ Σ_f A_f Σ_j (x_i − x_j), whose sum over j is in the others. Returns the product of x and the result.
    fn gather(&self, gradients: &[[Vec3; 3]], sums: &[[f64; 4]], x: Option<&[DVec3]>, out: &mut Vec<DVec3>) -> f64 {
        let gradients = gradients.as_flattened();
        let at = |local: usize, own: DVec3| {
            if !self.is_free[local] {
                return DVec3::ZERO;
            }
            let mut sum = own * self.evenness[local];
            for &slot in self.faces().slots(local) {
                let [change, even @ ..] = sums[slot as usize / 3];
                sum += gradients[slot as usize].as_dvec3() * change - DVec3::from_array(even);
            }
            sum
        };
        out.resize(self.is_free.len(), DVec3::ZERO);
        let chunks = out.par_chunks_mut(CHUNK).enumerate();
        let partial: Vec<f64> = chunks
            .map(|(chunk, out)| {
                let mut along = 0.0;
                for (place, out) in out.iter_mut().enumerate() {
                    let local = chunk * CHUNK + place;
                    let own = x.map_or(DVec3::ZERO, |x| x[local]);
                    *out = at(local, own);
                    along += own.dot(*out);
                }
                along
            })
            .collect();
        partial.iter().sum()
    }
}

impl Steps {
    /// Goes this far along the direction, whose image is known, and conditions the residual that is left. Returns the
    /// product of both.
    fn walk(&mut self, length: f64) -> f64 {
        let moved = self
            .correction
            .par_chunks_mut(CHUNK)
            .zip(self.residual.par_chunks_mut(CHUNK));
        let along = self.direction.par_chunks(CHUNK).zip(self.image.par_chunks(CHUNK));
        let conditioned = self.conditioned.par_chunks_mut(CHUNK);
        let conditioned = conditioned.zip(self.inverse_blocks.par_chunks(CHUNK));
        let chunks = moved.zip(along).zip(conditioned).with_min_len(CHUNKS_A_TASK);
        let partial: Vec<f64> = chunks
            .map(
                |(((correction, residual), (direction, image)), (conditioned, blocks))| {
                    let mut square = 0.0;
                    for place in 0..correction.len() {
                        correction[place] += direction[place] * length;
                        residual[place] -= image[place] * length;
                        conditioned[place] = blocks[place].as_dmat3() * residual[place];
                        square += residual[place].dot(conditioned[place]);
                    }
                    square
                },
            )
            .collect();
        partial.iter().sum()
    }

    /// Makes the next direction: the conditioned residual and this share of the last direction.
    fn turn(&mut self, share: f64) {
        let chunks = self
            .direction
            .par_chunks_mut(CHUNK)
            .zip(self.conditioned.par_chunks(CHUNK));
        chunks.with_min_len(CHUNKS_A_TASK).for_each(|(direction, conditioned)| {
            for (direction, conditioned) in direction.iter_mut().zip(conditioned) {
                *direction = *conditioned + *direction * share;
            }
        });
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
