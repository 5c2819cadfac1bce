//! A shape: positions, the cells' rotations, energy and gradient.
//!
//! Two passes over the cells. The first gathers a cell's displaced ring into its matrix S, fits eight cells' rotations
//! at once, and sums the energy; the second gathers the ring's rotations into the gradient, and is skipped for a shape
//! that new targets replace (see `fit_pass` and `gradient_pass`).

use pliant_mesh::vectors;
use rayon::prelude::*;

use super::cells::{Cells, Quad, minus, vector};
use super::fit_pass::{FitPass, Out, Turning};
use super::gradient_pass::{GradientPass, Laplacians, Turn, turn_of};
use super::history::Field;
pub(crate) use super::rotation::{IDENTITY, Rotation, narrow, wide};
use crate::descent::springs::Springs;
use crate::numerical::rows::CHUNK;

/// A shape. Rotations and energy are valid after a measurement of the displacements, the gradient after it was
/// computed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    /// The displacement of each local vertex, in world units; the fourth number is zero.
    pub displacements: Vec<Quad>,
    /// For each cell the best rotation for the displacements, as a quaternion x, y, z, w. **f32**: the next fit only
    /// starts from it.
    pub rotations: Vec<Rotation>,
    /// dE/dp of each solved vertex, in units of [`Cells::unit`]. **f32**: it only makes a direction; a line search on
    /// the energy finds the length.
    pub gradient: Field,
    /// E, in squared world units.
    pub energy: f64,
}

/// Scratch memory for an evaluation, kept from one to the next.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// R − 1 of each cell, or Z if the cell bends, column by column. **f32**: all neighbours read each, and for the
    /// gradient alone.
    turns: Vec<Turn>,
    /// Σ_v w_iv D_v − (R_i − 1) Σ_v (G_iv − G_vi) of each solved cell: the difference of two large sums. **f32**
    /// likewise.
    laplacians: Vec<[f32; 4]>,
}

/// The start of a fit.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Guesses<'a> {
    /// The shape's own rotations.
    Own,
    /// These rotations.
    Given(&'a [Rotation]),
}

impl Shape {
    /// Adds the energy of springs and loads.
    pub fn add_energy_of(&mut self, springs: &Springs<f32>) {
        self.energy = springs.added_energy(self.energy, |vertex| vector(self.displacements[vertex]));
    }

    /// Adds the forces of springs and loads to the gradient.
    pub fn add_gradient_of(&mut self, springs: &Springs<f32>) {
        let displacements = &self.displacements;
        springs.add_gradient(|vertex| vector(displacements[vertex]), &mut self.gradient);
    }

    /// The rest shape of `vertex_count` vertices.
    pub fn at_rest(vertex_count: usize, cell_count: usize, solved_count: usize) -> Self {
        Self {
            displacements: vec![[0.0; 4]; vertex_count],
            rotations: vec![IDENTITY; cell_count],
            gradient: vec![[0.0; 3]; solved_count],
            energy: 0.0,
        }
    }
}

impl Cells {
    /// Fits the rotations to the displacements, and finds energy and gradient.
    pub fn evaluate(&self, shape: &mut Shape, guesses: Guesses<'_>, scratch: &mut Scratch) {
        self.measure(shape, guesses, scratch);
        self.find_gradient(shape, scratch);
    }

    /// Fits the rotations to the displacements, and finds the energy.
    pub fn measure(&self, shape: &mut Shape, guesses: Guesses<'_>, scratch: &mut Scratch) {
        self.gather_all(shape, guesses, Turning::Best, scratch);
    }

    /// Finds the gradient of the shape with its present rotations, best or not.
    pub fn find_pull(&self, shape: &mut Shape, scratch: &mut Scratch) {
        if !self.bending.is_empty() {
            // The affine maps contribute too, which needs their rings.
            self.gather_all(shape, Guesses::Own, Turning::Given, scratch);
            self.find_gradient(shape, scratch);
            return;
        }
        scratch.turns.resize(self.count(), [[0.0; 4]; 3]);
        scratch
            .turns
            .par_chunks_mut(CHUNK)
            .zip(shape.rotations.par_chunks(CHUNK))
            .for_each(|(turns, rotations)| {
                for (turn, rotation) in turns.iter_mut().zip(rotations) {
                    *turn = turn_of(*rotation);
                }
            });
        let Shape {
            displacements,
            gradient,
            ..
        } = shape;
        self.gradient_pass(gradient, &scratch.turns, Laplacians::Of(displacements));
    }

    fn gather_all(&self, shape: &mut Shape, guesses: Guesses<'_>, turning: Turning, scratch: &mut Scratch) {
        let Shape {
            displacements,
            rotations,
            energy,
            ..
        } = shape;
        let displacements = displacements.as_slice();
        let Scratch { turns, laplacians } = scratch;
        turns.resize(self.count(), [[0.0; 4]; 3]);
        laplacians.resize(self.count(), [0.0; 4]);
        let arch = vectors();
        let partial: Vec<f64> = rotations
            .par_chunks_mut(CHUNK)
            .zip(turns.par_chunks_mut(CHUNK))
            .zip(laplacians.par_chunks_mut(CHUNK))
            .enumerate()
            .map(|(chunk, ((rotations, turns), laplacians))| {
                let first = chunk * CHUNK;
                if let Guesses::Given(given) = guesses {
                    rotations.copy_from_slice(&given[first..first + rotations.len()]);
                }
                let out = Out {
                    rotations,
                    turns,
                    laplacians,
                };
                arch.dispatch(FitPass {
                    cells: self,
                    first,
                    displacements,
                    turning,
                    out,
                })
            })
            .collect();
        let constant: f64 = self
            .constant
            .iter()
            .map(|&(a, b, factor)| {
                let d = minus(displacements[b as usize], displacements[a as usize]);
                factor * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
            })
            .sum();
        let sum = partial.iter().sum::<f64>() + constant;
        // Only rounding can make it negative; NaN stays NaN.
        *energy = if sum < 0.0 { 0.0 } else { sum };
    }

    /// Finds the gradient of the shape that was last measured with this scratch.
    pub fn find_gradient(&self, shape: &mut Shape, scratch: &Scratch) {
        let Scratch { turns, laplacians } = scratch;
        self.gradient_pass(&mut shape.gradient, turns, Laplacians::Known(laplacians));
    }

    fn gradient_pass(&self, gradient: &mut [[f32; 3]], turns: &[Turn], laplacians: Laplacians<'_>) {
        let arch = vectors();
        gradient
            .par_chunks_mut(CHUNK)
            .enumerate()
            .for_each(|(chunk, gradient)| {
                arch.dispatch(GradientPass {
                    cells: self,
                    first: chunk * CHUNK,
                    gradient,
                    turns,
                    laplacians,
                });
            });
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use pliant_mesh::{Surface, Topology, shapes};

    use super::{Guesses, IDENTITY, Scratch, Shape, wide};
    use crate::Laplacian;
    use crate::coarse::domain::Domain;
    use crate::methods::arap::cells::Cells;
    use crate::methods::arap::{bending, rims, spokes};
    use glam::{DQuat, DVec3};

    fn noise(k: usize) -> f64 {
        ((k as f64 * 12.9898).sin() * 43_758.545).fract()
    }

    fn evaluated(domain: &Domain, cells: &Cells, displacements: &[DVec3]) -> Shape {
        let mut shape = Shape::at_rest(displacements.len(), domain.cell_count, domain.solved_count);
        for (own, d) in shape.displacements.iter_mut().zip(displacements) {
            *own = [d.x, d.y, d.z, 0.0];
        }
        cells.evaluate(&mut shape, Guesses::Own, &mut Scratch::default());
        shape
    }

    fn shaken(domain: &Domain, size: f64) -> Vec<DVec3> {
        (0..domain.vertices.len())
            .map(|v| DVec3::new(noise(3 * v), noise(3 * v + 1), noise(3 * v + 2)) * 0.6 * size)
            .collect()
    }

    fn edge(surface: &Surface) -> f64 {
        surface.positions[1].distance(surface.positions[0])
    }

    /// Every energy on closed, open and non-manifold surfaces with stiffness, some vertices constrained.
    fn each(check: impl Fn(&Surface, &Topology, &[f64], &Domain, &Cells, &str)) {
        for drawn in [shapes::torus(20, 10), shapes::grid(7, 9), shapes::non_manifold_fan(5)] {
            let model = shapes::model(drawn);
            let (surface, topology) = (&model.surface, &model.topology);
            let count = surface.positions.len() as u32;
            let order: Vec<u32> = (0..count).rev().filter(|v| v % 3 != 0 && v % 11 < 8).collect();
            let domain = Domain::of(surface, topology, &order);
            let stiffness: Vec<f64> = (0..count).map(|v| 1.0 + f64::from(v % 5)).collect();
            let laplacian = Laplacian::of(surface, topology, &stiffness);
            let rims = rims::cells(surface, topology, &stiffness, &domain, &[]);
            check(surface, topology, &stiffness, &domain, &rims, "rims");
            let spokes = spokes::cells(surface, &laplacian, &domain);
            check(surface, topology, &stiffness, &domain, &spokes, "spokes");
            let bends = bending::stiffness(surface, &domain, 0.05);
            let ties = bending::ties(surface, topology, &domain, bends);
            let mut smooth = rims::cells(surface, topology, &stiffness, &domain, &ties);
            bending::add(&mut smooth, &ties);
            check(surface, topology, &stiffness, &domain, &smooth, "smooth");
        }
    }

    #[test]
    fn the_gradient_is_that_of_the_energy() {
        each(|surface, _, _, domain, cells, name| {
            let size = edge(surface);
            let displacements = shaken(domain, size);
            let gradient: Vec<[f64; 3]> = evaluated(domain, cells, &displacements)
                .gradient
                .iter()
                .map(|own| own.map(|value| f64::from(value) * cells.unit()))
                .collect();
            let largest = gradient.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
            for vertex in (0..domain.solved_count).step_by(7) {
                for axis in 0..3 {
                    let step = 1e-5 * size;
                    let beside = |sign: f64| {
                        let mut moved = displacements.clone();
                        moved[vertex][axis] += sign * step;
                        evaluated(domain, cells, &moved).energy
                    };
                    let slope = (beside(1.0) - beside(-1.0)) / (2.0 * step);
                    let error = (slope - gradient[vertex][axis]).abs();
                    assert!(
                        error < 1e-6 * largest,
                        "{name} {vertex} {axis}: {slope} {}",
                        gradient[vertex][axis]
                    );
                }
            }
        });
    }

    /// ½ Σ_i Σ_f∋i ⅓ Σ_e w |e' − R_i e|², edge by edge, by its definition.
    #[test]
    fn the_energy_over_rims_is_the_sum_of_its_definition() {
        each(|surface, topology, stiffness, domain, cells, name| {
            if name != "rims" {
                return;
            }
            let displacements = shaken(domain, edge(surface));
            let mut shape = evaluated(domain, cells, &displacements);
            // The rotations are the best to the last bit, so their rounding to single precision enters squared.
            for _ in 0..3 {
                cells.measure(&mut shape, Guesses::Own, &mut Scratch::default());
            }
            let metric = crate::operators::face_terms::Metric::cotangent_area();
            let mut expected = 0.0;
            for cell in 0..domain.cell_count {
                let rotation = wide(shape.rotations[cell]);
                let vertex = pliant_mesh::SurfaceVertex(domain.vertices[cell]);
                for face in topology.faces(vertex, &surface.triangles) {
                    let corners = surface.triangles[face as usize];
                    let lengths = pliant_mesh::edge_lengths(corners.map(|corner| surface.positions[corner.index()]));
                    let weights = metric.face(stiffness, corners, lengths).half_cotangents;
                    for k in 0..3 {
                        let (a, b) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
                        let rest = surface.positions[b.index()] - surface.positions[a.index()];
                        let d = |corner: pliant_mesh::SurfaceVertex| {
                            displacements[domain.local_of[corner.index()] as usize]
                        };
                        let edge = rest + d(b) - d(a);
                        expected += weights[k] / 6.0 * (edge - rotation * rest).length_squared();
                    }
                }
            }
            let error = (shape.energy - expected).abs() / expected;
            assert!(error < 1e-12, "{error:e}");
        });
    }

    #[test]
    fn the_rest_shape_costs_nothing_and_a_rigid_motion_hardly_anything() {
        each(|surface, _, _, domain, cells, name| {
            let rest = evaluated(domain, cells, &vec![DVec3::ZERO; domain.vertices.len()]);
            assert_eq!(rest.energy, 0.0, "{name}");
            assert!(rest.gradient.iter().all(|g| *g == [0.0; 3]), "{name}");
            assert!(rest.rotations.iter().all(|q| *q == IDENTITY), "{name}");
            let rotation = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 2.5);
            let carried: Vec<DVec3> = domain
                .vertices
                .iter()
                .map(|&v| surface.positions[v as usize])
                .map(|p| rotation * p + DVec3::ONE - p)
                .collect();
            let shape = evaluated(domain, cells, &carried);
            assert!(shape.energy < 1e-12 * cells.scale, "{name}: {:e}", shape.energy);
        });
    }
}
