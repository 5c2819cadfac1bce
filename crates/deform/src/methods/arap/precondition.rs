//! The factored Laplacian: a global step, and the handles' harmonic weights.

use pliant_mesh::Cancel;
use rayon::prelude::*;

use super::cells::Quad;
use super::matrix::System;
use crate::budget::{Budget, filled};
use crate::coarse::domain::Domain;
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::CHUNKS_A_TASK;
use crate::sparse::cholesky::Factor;
use crate::sparse::factor_error::FactorError;
use crate::sparse::solve::rhs::{Real, Rhs};
use crate::sparse::solve::substitution::{Scratch, Substitution};
use crate::sparse::system_error::SystemError;

/// An approximate inverse of the system on the solved vertices.
///
/// It is kept in single precision if that is accurate enough for a descent direction, which halves the bytes to read,
/// and the next step corrects its rounding. Gradients and positions stay double.
#[derive(Debug)]
pub(crate) struct Preconditioner {
    solver: Solver,
    scale: Vec<f64>,
}

#[derive(Debug)]
enum Solver {
    Single(Substitution<f32>),
    Double(Substitution<f64>),
}

/// Scratch memory for applying it, kept from one step to the next.
#[derive(Debug, Default)]
pub(crate) struct MapScratch {
    single: (Vec<Rhs<f32>>, Scratch<f32>),
    double: (Vec<Rhs<f64>>, Scratch<f64>),
}

/// The largest allowed error of a constant's solution: accurate enough for a descent direction.
const TOLERANCE: f64 = 1e-2;

/// A factorisation's refusal, whose columns are the domain's vertices.
fn refused(error: FactorError, domain: &Domain) -> SystemError {
    SystemError::of(error, |local| domain.vertices[local])
}

impl Preconditioner {
    /// Factors and checks the system, whose supernodes end at `ends`; also returns each handle's weights (see
    /// [`Preconditioner::weights`]).
    pub fn of(
        system: &System,
        ends: &[u32],
        weights: &WeightInput<'_>,
        budget: Budget,
        cancel: &Cancel,
    ) -> Result<(Self, Vec<f64>), SystemError> {
        // The factor is copied twice, once in half the bytes.
        let factor = Factor::to_descend_by(&system.matrix, ends, budget.shared_by(2.5), cancel);
        let factor = factor.map_err(|error| refused(error, weights.domain))?;
        Self::checked(&factor, system, weights, cancel)
    }

    fn checked(
        factor: &Factor,
        system: &System,
        weights: &WeightInput<'_>,
        cancel: &Cancel,
    ) -> Result<(Self, Vec<f64>), SystemError> {
        let scale = system.matrix.scale.clone();
        let refuse = |error| refused(error, weights.domain);
        let double = Self {
            solver: Solver::Double(factor.substitution().map_err(refuse)?),
            scale: scale.clone(),
        };
        let (vertex, error) = double.miss(system);
        if error > TOLERANCE {
            let vertex = weights.domain.vertices[vertex];
            return Err(SystemError::Inaccurate { vertex, error });
        }
        let weights = double.weights(system, weights).map_err(refuse)?;
        cancel.check().map_err(|_| SystemError::Cancelled)?;
        let single = Self {
            solver: Solver::Single(factor.substitution().map_err(refuse)?),
            scale,
        };
        let (_, error) = single.miss(system);
        Ok((if error > TOLERANCE { double } else { single }, weights))
    }

    /// The largest error of a constant, and its vertex.
    fn miss(&self, system: &System) -> (usize, f64) {
        let ones = self.extended(system, [|_: u32| 1.0; 1]);
        let error = |row: &Quad| {
            let error = (row[0] - 1.0).abs();
            if error.is_nan() { f64::INFINITY } else { error }
        };
        let errors = ones.iter().map(error).enumerate();
        errors.fold((0, 0.0), |worst, next| if next.1 > worst.1 { next } else { worst })
    }

    /// The number of entries that the factor stores.
    pub fn stored(&self) -> usize {
        match &self.solver {
            Solver::Single(solver) => solver.stored(),
            Solver::Double(solver) => solver.stored(),
        }
    }

    /// `mapped` ← the inverse of the system times `field`.
    pub fn map(&self, field: &[[f32; 3]], mapped: &mut [[f32; 3]], scratch: &mut MapScratch) {
        let wide = |row: &[f32; 3]| [row[0], row[1], row[2], 0.0].map(f64::from);
        match &self.solver {
            Solver::Single(solver) => {
                let (x, scratch) = &mut scratch.single;
                self.solve(solver, field, wide, x, scratch);
                narrowed(x, &self.scale, mapped);
            }
            Solver::Double(solver) => {
                let (x, scratch) = &mut scratch.double;
                self.solve(solver, field, wide, x, scratch);
                narrowed(x, &self.scale, mapped);
            }
        }
    }

    fn solve<T: Real, F: Sync>(
        &self,
        solver: &Substitution<T>,
        field: &[F],
        row: impl Fn(&F) -> Quad + Sync,
        x: &mut Vec<Rhs<T>>,
        scratch: &mut Scratch<T>,
    ) {
        x.resize(field.len(), Rhs::default());
        x.par_chunks_mut(CHUNK)
            .zip(field.par_chunks(CHUNK))
            .zip(self.scale.par_chunks(CHUNK))
            .with_min_len(CHUNKS_A_TASK)
            .for_each(|((x, field), scale)| {
                for ((x, value), &scale) in x.iter_mut().zip(field).zip(scale) {
                    let row = row(value);
                    for k in 0..4 {
                        x[k] = T::of(row[k] * scale);
                    }
                }
            });
        solver.solve(x, scratch);
    }

    /// Up to four functions on the solved vertices for which the system's forces vanish, with the values
    /// `of_constrained` on the constrained local ones.
    fn extended<const K: usize>(&self, system: &System, of_constrained: [impl Fn(u32) -> f64; K]) -> Vec<Quad> {
        let mut pulls = vec![[0.0; 4]; self.scale.len()];
        for (k, values) in of_constrained.iter().enumerate().take(4) {
            for (own, pull) in pulls.iter_mut().zip(system.pull(values)) {
                own[k] = pull;
            }
        }
        let mut scratch = MapScratch::default();
        let widened = |rows: Vec<Quad>| {
            let rows = rows.into_iter().zip(&self.scale);
            rows.map(|(row, &scale)| row.map(|value| value * scale)).collect()
        };
        match &self.solver {
            Solver::Double(solver) => {
                let (x, scratch) = &mut scratch.double;
                self.solve(solver, &pulls, |row| *row, x, scratch);
                widened(std::mem::take(x))
            }
            Solver::Single(solver) => {
                let (x, scratch) = &mut scratch.single;
                self.solve(solver, &pulls, |row| *row, x, scratch);
                widened(x.iter().map(|row| row.map(f64::from)).collect())
            }
        }
    }

    /// Each handle's weight on each cell, row-major: 1 on its own vertices, 0 on other constrained ones, harmonic in
    /// the system's sense between. Around a vertex without a fixed one they sum to 1.
    fn weights(&self, system: &System, input: &WeightInput<'_>) -> Result<Vec<f64>, FactorError> {
        let WeightInput {
            domain,
            handle_count,
            handle_of,
            unheld,
        } = *input;
        let mut weights = filled(0.0, domain.cell_count * handle_count)?;
        let handles: Vec<usize> = (0..handle_count).collect();
        for group in handles.chunks(4) {
            // Four right-hand sides per solve; unused ones of the last group are empty.
            let of = |k: usize| {
                let handle = group.get(k).copied();
                move |other: u32| f64::from(u8::from(handle.is_some() && handle_of(other) == handle))
            };
            let values = self.extended(system, [of(0), of(1), of(2), of(3)]);
            for (vertex, values) in values.iter().enumerate() {
                for (&handle, value) in group.iter().zip(values) {
                    // Negative cotangents and bending may move it outside.
                    weights[vertex * handle_count + handle] = value.clamp(0.0, 1.0);
                }
            }
        }
        for vertex in domain.solved_count..domain.cell_count {
            if let Some(handle) = handle_of(vertex as u32) {
                weights[vertex * handle_count + handle] = 1.0;
            }
        }
        for (vertex, weights) in weights.chunks_exact_mut(handle_count.max(1)).enumerate() {
            let sum: f64 = weights.iter().sum();
            if vertex < domain.solved_count && sum > 0.0 && unheld(vertex as u32) {
                for weight in weights {
                    *weight /= sum;
                }
            }
        }
        Ok(weights)
    }
}

/// The inputs of the handles' weights besides the system.
#[derive(Clone, Copy)]
pub(crate) struct WeightInput<'a> {
    pub domain: &'a Domain,
    pub handle_count: usize,
    /// The handle of a local vertex.
    pub handle_of: &'a dyn Fn(u32) -> Option<usize>,
    /// True if nothing is fixed around a local vertex.
    pub unheld: &'a dyn Fn(u32) -> bool,
}

/// `mapped` ← S x in single precision.
fn narrowed<T: Real>(x: &[Rhs<T>], scale: &[f64], mapped: &mut [[f32; 3]]) {
    mapped
        .par_chunks_mut(CHUNK)
        .zip(x.par_chunks(CHUNK))
        .zip(scale.par_chunks(CHUNK))
        .with_min_len(CHUNKS_A_TASK)
        .for_each(|((mapped, x), scale)| {
            for ((mapped, x), &scale) in mapped.iter_mut().zip(x).zip(scale) {
                for k in 0..3 {
                    mapped[k] = (x[k].wide() * scale) as f32;
                }
            }
        });
}
