//! Pressure, which takes the divergence out of a velocity.
//!
//! The weak divergence of a velocity u that is constant on triangles is b_i = Σ_t A_t ∇φ_i · u_t over the triangles at
//! vertex i, φ_i being the hat function there. The pressure p with −L p = b has the same divergence, so u − ∇p has none
//! [SY04, Sta99]. No condition is set at borders: the natural one of the weak form lets no fluid through and lets it
//! slip along. Velocities without divergence stay as they are, harmonic ones too: only a gradient is taken off.

use glam::DVec2;
use pliant_deform::PoissonEquation;
use rayon::prelude::*;

use crate::error::FlowError;
use crate::fluid::Fluid;
use crate::sums::{CHUNK, sum};

/// Divergence below this share of the velocity over the mean edge is not corrected: rounding leaves about 1e-14.
const ENOUGH: f64 = 1e-11;

/// The most corrections: on thin triangles the factor's rounding leaves a little, which the next one takes.
const MOST: usize = 4;

/// The factored Laplacian, and memory for its fields.
#[derive(Debug)]
pub(crate) struct Pressure {
    equation: PoissonEquation,
    /// The weak divergence at each vertex.
    load: Vec<f64>,
    pressure: Vec<f64>,
    /// All pressure of the last projection, whose gradient has the unit of a velocity.
    total: Vec<f64>,
}

impl Pressure {
    pub fn new(equation: PoissonEquation, vertex_count: usize) -> Self {
        Self {
            equation,
            load: vec![0.0; vertex_count],
            pressure: vec![0.0; vertex_count],
            total: vec![0.0; vertex_count],
        }
    }

    /// The number of entries of the Laplacian's factor.
    pub fn factor_len(&self) -> usize {
        self.equation.factor_len()
    }

    /// All pressure of the last projection: the velocity has lost its gradient.
    pub fn total(&self) -> &[f64] {
        &self.total
    }

    /// Takes the gradient part off a velocity if it is not without divergence already.
    pub fn project_added(
        &mut self,
        fluid: &Fluid<'_>,
        velocity: &mut [DVec2],
        room: &mut Vec<f64>,
    ) -> Result<(), FlowError> {
        let total = std::mem::replace(&mut self.total, vec![0.0; fluid.vertex_count()]);
        let fastest = fluid.speeds(velocity).into_iter().fold(0.0, f64::max);
        let projected = self.project(fluid, velocity, fastest, room);
        self.total = total;
        projected
    }

    /// Takes the gradient part off a velocity. The tolerance refers to `fastest`, its norm on the component with the
    /// largest, or a little more, as given: if all of it is a gradient, only rounding is left. `room` is scratch memory.
    pub fn project(
        &mut self,
        fluid: &Fluid<'_>,
        velocity: &mut [DVec2],
        fastest: f64,
        room: &mut Vec<f64>,
    ) -> Result<(), FlowError> {
        let enough = ENOUGH * fastest / fluid.mean_edge;
        self.total.fill(0.0);
        room.resize(room.len().max(3 * fluid.triangle_count()), 0.0);
        let (terms, _) = room[..3 * fluid.triangle_count()].as_chunks_mut();
        let each = terms.par_iter_mut().with_min_len(CHUNK).enumerate();
        each.for_each(|(triangle, terms)| *terms = corner_terms(fluid, triangle, velocity[triangle]));
        for _ in 0..MOST {
            sum_terms(fluid, terms, &mut self.load);
            if norm(fluid, &self.load) <= enough {
                break;
            }
            let solved = self.equation.solve(&self.load, &mut self.pressure);
            solved.map_err(|error| FlowError::of_solve(&error))?;
            let pressure = &self.pressure;
            self.total
                .iter_mut()
                .zip(pressure)
                .for_each(|(total, pressure)| *total += pressure);
            let subtract = |(triangle, (velocity, terms)): (usize, (&mut DVec2, &mut [f64; 3]))| {
                let values = fluid.corners(triangle).map(|vertex| pressure[vertex]);
                *velocity -= fluid.domain.charts[triangle].gradient(values);
                *terms = corner_terms(fluid, triangle, *velocity);
            };
            let pairs = velocity.par_iter_mut().zip(&mut *terms).with_min_len(CHUNK);
            pairs.enumerate().for_each(subtract);
        }
        Ok(())
    }
}

/// Twice the share of a triangle in the weak divergence at each of its corners.
#[inline]
fn corner_terms(fluid: &Fluid<'_>, triangle: usize, velocity: DVec2) -> [f64; 3] {
    // A ∇φ is half the edge opposite, turned to the left.
    let term = |k| fluid.domain.charts[triangle].edge(k).perp_dot(velocity);
    [term(0), term(1), term(2)]
}

/// Fills `out` with the weak divergence at each vertex.
fn sum_terms(fluid: &Fluid<'_>, terms: &[[f64; 3]], out: &mut [f64]) {
    let terms = terms.as_flattened();
    let of = |(vertex, out): (usize, &mut f64)| {
        let corners = fluid.domain.fans.corners(vertex).iter();
        *out = 0.5 * corners.map(|&corner| terms[corner as usize]).sum::<f64>();
    };
    out.par_iter_mut().with_min_len(CHUNK).enumerate().for_each(of);
}

/// The root of the squared divergence's integral.
pub(crate) fn divergence_norm(fluid: &Fluid<'_>, velocity: &[DVec2]) -> f64 {
    let mut load = vec![0.0; fluid.vertex_count()];
    let terms: Vec<[f64; 3]> = (0..fluid.triangle_count())
        .map(|triangle| corner_terms(fluid, triangle, velocity[triangle]))
        .collect();
    sum_terms(fluid, &terms, &mut load);
    norm(fluid, &load)
}

/// The same of a weak divergence.
fn norm(fluid: &Fluid<'_>, load: &[f64]) -> f64 {
    let squared = |vertex: usize| match fluid.masses[vertex] {
        mass if mass > 0.0 => [load[vertex] * load[vertex] / mass],
        _ => [0.0],
    };
    let [squared] = sum(load.len(), squared);
    squared.sqrt()
}
