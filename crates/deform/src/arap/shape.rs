//! A shape under an energy: where the vertices are, how the cells are turned, what it costs and which way is down.
//!
//! Two passes over the cells. The first gathers a cell's displaced ring into its matrix S, fits eight cells' rotations
//! at once, and sums the energy; the second gathers the ring's turns into the gradient, which a shape that new targets
//! leave behind does without. Both run on whatever vectors
//! the machine has (see [`crate::lanes`]).

use glam::{DMat3, DQuat, DVec3};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::cells::{Cells, Quad};
use crate::lanes::{self, LANES, Lanes, Matrices, Quaternions};
use crate::operators::CHUNK;
use crate::rotation::fit_anew;

/// A shape; rotations and energy belong to the displacements once they were measured, the gradient once that was found.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    /// Of each local vertex, in world units; the fourth number is zero.
    pub displacements: Vec<Quad>,
    /// Of each cell: the best one for the displacements, as a quaternion x, y, z, w.
    pub rotations: Vec<Quad>,
    /// dE/dp of each solved vertex.
    pub gradient: Vec<Quad>,
    /// E, in squared world units.
    pub energy: f64,
}

/// Room for an evaluation, kept from one to the next.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// R − 1 of each cell, column by column. **f32**: each is read by all its neighbours, and for the gradient alone.
    turns: Vec<Turn>,
    /// Σ_v w_iv D_v of each cell.
    laplacians: Vec<Quad>,
    /// The bending force of each cell.
    moments: Vec<Quad>,
}

/// R − 1, column by column.
type Turn = [[f32; 4]; 3];

/// Where a fit starts.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Guesses<'a> {
    /// At the shape's own rotations.
    Own,
    /// At these.
    Given(&'a [Quad]),
}

/// Where a gradient has the cells' Σ_v w_iv D_v from.
#[derive(Clone, Copy, Debug)]
enum Laplacians<'a> {
    /// From the measure.
    Known(&'a [Quad]),
    /// From these displacements, with weights in single precision.
    Of(&'a [Quad]),
}

/// Which rotations cells get.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Turning {
    /// The best ones.
    Best,
    /// Those where a fit would start.
    Given,
}

impl Shape {
    /// The rest shape of `vertex_count` vertices.
    pub fn at_rest(vertex_count: usize, cell_count: usize, solved_count: usize) -> Self {
        Self {
            displacements: vec![[0.0; 4]; vertex_count],
            rotations: vec![IDENTITY; cell_count],
            gradient: vec![[0.0; 4]; solved_count],
            energy: 0.0,
        }
    }
}

/// The quaternion that turns nothing.
pub(crate) const IDENTITY: Quad = [0.0, 0.0, 0.0, 1.0];

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

    /// Finds the gradient of the shape with its rotations as they are, best or not.
    pub fn find_pull(&self, shape: &mut Shape, scratch: &mut Scratch) {
        if !self.bending.is_empty() {
            // Neighbours' moments enter, which are not known before theirs.
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
                    let turned = DMat3::from_quat(DQuat::from_array(*rotation)) - DMat3::IDENTITY;
                    *turn = turned
                        .to_cols_array_2d()
                        .map(|[x, y, z]| [x, y, z, 0.0].map(|v| v as f32));
                }
            });
        let Shape {
            displacements,
            gradient,
            ..
        } = shape;
        self.gradient_pass(gradient, &scratch.turns, Laplacians::Of(displacements), &[]);
    }

    fn gather_all(&self, shape: &mut Shape, guesses: Guesses<'_>, turning: Turning, scratch: &mut Scratch) {
        let Shape {
            displacements,
            rotations,
            energy,
            ..
        } = shape;
        let displacements = displacements.as_slice();
        let Scratch {
            turns,
            laplacians,
            moments,
        } = scratch;
        turns.resize(self.count(), [[0.0; 4]; 3]);
        laplacians.resize(self.count(), [0.0; 4]);
        moments.resize(self.bending.len(), [0.0; 4]);
        let mut moment_chunks: Vec<&mut [Quad]> = moments.chunks_mut(CHUNK).collect();
        // Without bending there are no moments.
        moment_chunks.resize_with(self.count().div_ceil(CHUNK), Default::default);
        let arch = Arch::new();
        let partial: Vec<f64> = rotations
            .par_chunks_mut(CHUNK)
            .zip(turns.par_chunks_mut(CHUNK))
            .zip(laplacians.par_chunks_mut(CHUNK))
            .zip(moment_chunks)
            .enumerate()
            .map(|(chunk, (((rotations, turns), laplacians), moments))| {
                let first = chunk * CHUNK;
                if let Guesses::Given(given) = guesses {
                    rotations.copy_from_slice(&given[first..first + rotations.len()]);
                }
                let out = Out {
                    rotations,
                    turns,
                    laplacians,
                    moments,
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
        // Rounding alone can carry it below; what is not a number stays so.
        *energy = if sum < 0.0 { 0.0 } else { sum };
    }

    /// Finds the gradient of the shape that was measured with this scratch last.
    pub fn find_gradient(&self, shape: &mut Shape, scratch: &Scratch) {
        let Scratch {
            turns,
            laplacians,
            moments,
        } = scratch;
        self.gradient_pass(&mut shape.gradient, turns, Laplacians::Known(laplacians), moments);
    }

    fn gradient_pass(&self, gradient: &mut [Quad], turns: &[Turn], laplacians: Laplacians<'_>, moments: &[Quad]) {
        let arch = Arch::new();
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
                    moments,
                });
            });
    }

    /// Rotations, turns, Laplacians and moments of the cells from `first` on; their energy.
    #[inline(always)]
    fn fit(&self, first: usize, displacements: &[Quad], turning: Turning, out: Out<'_>) -> f64 {
        let Out {
            rotations,
            turns,
            laplacians,
            moments,
        } = out;
        let mut sum = 0.0;
        for start in (0..rotations.len()).step_by(LANES) {
            let count = LANES.min(rotations.len() - start);
            let mut s: Matrices = Default::default();
            let mut axial: [Lanes; 3] = Default::default();
            let mut guess: Quaternions = Default::default();
            guess[3] = Lanes::splat(1.0);
            for lane in 0..count {
                let cell = first + start + lane;
                let (mut b, laplacian, square) = self.gather(cell, displacements);
                laplacians[start + lane] = laplacian;
                sum += 0.25 * square;
                let [mut xx, mut xy, mut xz, mut yy, mut yz, mut zz] = self.rest[cell];
                if let Some(&[x, y, z, factor]) = self.bending.get(cell) {
                    for (k, rest) in [x, y, z].into_iter().enumerate() {
                        for row in 0..3 {
                            b[k][row] += factor * laplacian[row] * rest;
                        }
                    }
                    (xx, xy, xz) = (xx + factor * x * x, xy + factor * x * y, xz + factor * x * z);
                    (yy, yz, zz) = (yy + factor * y * y, yz + factor * y * z, zz + factor * z * z);
                    let square =
                        laplacian[0] * laplacian[0] + laplacian[1] * laplacian[1] + laplacian[2] * laplacian[2];
                    sum += 0.5 * factor * square;
                }
                axial[0].0[lane] = b[1][2] - b[2][1];
                axial[1].0[lane] = b[2][0] - b[0][2];
                axial[2].0[lane] = b[0][1] - b[1][0];
                let rest = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
                for column in 0..3 {
                    for row in 0..3 {
                        s[column][row].0[lane] = b[column][row] + rest[column][row];
                    }
                }
                for k in 0..4 {
                    guess[k].0[lane] = rotations[start + lane][k];
                }
            }
            for lane in count..LANES {
                for k in 0..3 {
                    s[k][k].0[lane] = 1.0;
                }
            }
            let mut rotation = guess;
            if turning == Turning::Best {
                let found;
                (rotation, found) = lanes::fit(&s, guess);
                for lane in (0..count).filter(|&lane| !found[lane]) {
                    refit(&s, guess, lane, &mut rotation);
                }
            }
            let [x, y, z, w] = rotation;
            // ⟨R − 1, S⟩ by the quaternion: 2 w (a · v) + 2 (v · S v − |v|² tr S).
            let v = [x, y, z];
            let mut inner = w * (axial[0] * x + axial[1] * y + axial[2] * z);
            let trace = s[0][0] + s[1][1] + s[2][2];
            for k in 0..3 {
                let sv = s[0][k] * x + s[1][k] * y + s[2][k] * z;
                inner = inner + v[k] * (sv - v[k] * trace);
            }
            let turned = lanes::turns(rotation);
            for lane in 0..count {
                sum -= 2.0 * inner.0[lane];
                for k in 0..4 {
                    rotations[start + lane][k] = rotation[k].0[lane];
                }
                for column in 0..3 {
                    for row in 0..3 {
                        turns[start + lane][column][row] = turned[column][row].0[lane] as f32;
                    }
                }
            }
            if !self.bending.is_empty() {
                for (lane, place) in (start..start + count).enumerate() {
                    let [x, y, z, factor] = self.bending[first + place];
                    for row in 0..3 {
                        let [a, b, c] = [0, 1, 2].map(|column| turned[column][row].0[lane]);
                        moments[place][row] = factor * (laplacians[place][row] - (a * x + b * y + c * z));
                    }
                }
            }
        }
        sum
    }

    /// B's columns, Σ w D and Σ w |D|² of a cell.
    #[inline(always)]
    fn gather(&self, cell: usize, displacements: &[Quad]) -> ([Quad; 3], Quad, f64) {
        let own = displacements[cell];
        let (mut b, mut laplacian, mut square) = ([[0.0; 4]; 3], [0.0; 4], [0.0; 4]);
        let around = self.around(cell);
        for (&end, towards) in self.ends[around.clone()].iter().zip(&self.towards[around]) {
            let d = minus(displacements[end as usize], own);
            for (k, column) in b.iter_mut().enumerate() {
                for row in 0..4 {
                    column[row] += d[row] * towards[k];
                }
            }
            for row in 0..4 {
                let weighted = d[row] * towards[3];
                laplacian[row] += weighted;
                square[row] += weighted * d[row];
            }
        }
        (b, laplacian, square[0] + square[1] + square[2])
    }

    /// The gradient of the solved vertices from `first` on.
    #[inline(always)]
    fn descend(
        &self,
        first: usize,
        gradient: &mut [Quad],
        turns: &[Turn],
        laplacians: Laplacians<'_>,
        moments: &[Quad],
    ) {
        for (place, gradient) in gradient.iter_mut().enumerate() {
            let cell = first + place;
            let mut sum = times_turn(&turns[cell], self.own[cell]);
            let around = self.around(cell);
            let entries = self.ends[around.clone()].iter().zip(&self.back[around.clone()]);
            match laplacians {
                Laplacians::Known(laplacians) => {
                    sum = minus(sum, laplacians[cell]);
                    for (&end, &back) in entries {
                        sum = minus(sum, times_turn(&turns[end as usize], back.map(f64::from)));
                    }
                }
                Laplacians::Of(displacements) => {
                    let own = displacements[cell];
                    for (&end, &back) in entries {
                        sum = minus(sum, times_turn(&turns[end as usize], back.map(f64::from)));
                        let d = minus(displacements[end as usize], own);
                        sum = minus(sum, d.map(|value| value * f64::from(back[3])));
                    }
                }
            }
            if !moments.is_empty() {
                let own = moments[cell];
                for (&end, back) in self.ends[around.clone()].iter().zip(&self.back[around]) {
                    let other = minus(moments[end as usize], own);
                    for row in 0..4 {
                        sum[row] += other[row] * f64::from(back[3]);
                    }
                }
            }
            sum[3] = 0.0;
            *gradient = sum;
        }
    }
}

/// [`Cells::fit`] compiled for the machine's vectors.
struct FitPass<'a> {
    cells: &'a Cells,
    first: usize,
    displacements: &'a [Quad],
    turning: Turning,
    out: Out<'a>,
}

impl WithSimd for FitPass<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        self.cells.fit(self.first, self.displacements, self.turning, self.out)
    }
}

/// [`Cells::descend`] compiled for the machine's vectors.
struct GradientPass<'a> {
    cells: &'a Cells,
    first: usize,
    gradient: &'a mut [Quad],
    turns: &'a [Turn],
    laplacians: Laplacians<'a>,
    moments: &'a [Quad],
}

impl WithSimd for GradientPass<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            cells,
            first,
            gradient,
            turns,
            laplacians,
            moments,
        } = self;
        cells.descend(first, gradient, turns, laplacians, moments);
    }
}

/// Where a chunk's results go.
struct Out<'a> {
    rotations: &'a mut [Quad],
    turns: &'a mut [Turn],
    laplacians: &'a mut [Quad],
    moments: &'a mut [Quad],
}

/// Fits one lane anew, without a guess.
#[cold]
fn refit(s: &Matrices, guess: Quaternions, lane: usize, rotation: &mut Quaternions) {
    let column = |c: usize| DVec3::new(s[c][0].0[lane], s[c][1].0[lane], s[c][2].0[lane]);
    let matrix = DMat3::from_cols(column(0), column(1), column(2));
    let start = DQuat::from_array(guess.map(|value| value.0[lane]));
    for (own, value) in rotation.iter_mut().zip(fit_anew(&matrix, start).to_array()) {
        own.0[lane] = value;
    }
}

/// (R − 1) v; the fourth number is nothing.
#[inline(always)]
fn times_turn(turn: &Turn, v: Quad) -> Quad {
    let mut product = [0.0; 4];
    for row in 0..4 {
        let [a, b, c] = turn.map(|column| f64::from(column[row]));
        product[row] = a * v[0] + b * v[1] + c * v[2];
    }
    product
}

#[inline(always)]
pub(crate) fn minus(a: Quad, b: Quad) -> Quad {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use pliant_mesh::{Surface, Topology, shapes};

    use super::{Guesses, IDENTITY, Scratch, Shape};
    use crate::Laplacian;
    use crate::arap::cells::{Cells, vector};
    use crate::arap::domain::Domain;
    use crate::arap::{bending, rims, spokes};
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
            let rims = rims::cells(surface, topology, &stiffness, &domain);
            check(surface, topology, &stiffness, &domain, &rims, "rims");
            let spokes = spokes::cells(surface, &laplacian, &domain);
            check(surface, topology, &stiffness, &domain, &spokes, "spokes");
            let mut smooth = rims;
            let bends = bending::stiffness(surface, &domain, 0.05);
            bending::add(&mut smooth, surface, &laplacian, &domain, bends);
            check(surface, topology, &stiffness, &domain, &smooth, "smooth");
        }
    }

    #[test]
    fn the_gradient_is_that_of_the_energy() {
        each(|surface, _, _, domain, cells, name| {
            let size = edge(surface);
            let displacements = shaken(domain, size);
            let gradient = evaluated(domain, cells, &displacements).gradient;
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

    /// ½ Σ_i Σ_f∋i ⅓ Σ_e w |e' − R_i e|², edge by edge as it is defined.
    #[test]
    fn the_energy_over_rims_is_the_sum_of_its_definition() {
        each(|surface, topology, stiffness, domain, cells, name| {
            if name != "rims" {
                return;
            }
            let displacements = shaken(domain, edge(surface));
            let shape = evaluated(domain, cells, &displacements);
            let metric = crate::operators::face_terms::Metric::cotangent_area();
            let mut expected = 0.0;
            for cell in 0..domain.cell_count {
                let rotation = DQuat::from_array(shape.rotations[cell]);
                for &face in topology.faces(pliant_mesh::SurfaceVertex(domain.vertices[cell])) {
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
            assert!(rest.gradient.iter().all(|g| vector(*g) == DVec3::ZERO), "{name}");
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
