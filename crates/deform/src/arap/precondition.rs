//! The factored Laplacian: a global step, and the handles' harmonic weights.

use pliant_mesh::Cancel;
use rayon::prelude::*;

use super::domain::Domain;
use super::matrix::System;
use crate::operators::CHUNK;
use crate::sparse::cholesky::{Factor, FactorError};

/// The inverse of the Laplacian on the solved vertices, or nearly so.
#[derive(Debug)]
pub(crate) struct Preconditioner {
    factor: Factor,
    scale: Vec<f64>,
}

/// Why there is none.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PreconditionError {
    /// The pivot of this solved vertex is not above zero.
    Pivot(usize),
    /// A constant is missed by this much at this solved vertex.
    Inaccurate(usize, f64),
    Memory,
    Cancelled,
}

/// What is added to the unit diagonal until it can be factored. It makes the quadratic larger, which still majorises
/// the energy: steps get shorter, results stay the same.
const SHIFTS: [f64; 5] = [0.0, 1e-13, 1e-11, 1e-9, 1e-7];

/// By how much a constant may be missed: enough to descend by.
const TOLERANCE: f64 = 1e-2;

impl Preconditioner {
    /// Factors and checks the system.
    pub fn of(system: &System, cancel: &Cancel) -> Result<Self, PreconditionError> {
        let mut failed = None;
        for shift in SHIFTS {
            cancel.check().map_err(|_| PreconditionError::Cancelled)?;
            match Factor::of(&system.matrix, shift, cancel) {
                Ok(factor) => {
                    let scale = system.matrix.scale.clone();
                    let preconditioner = Self { factor, scale };
                    preconditioner.check(system)?;
                    return Ok(preconditioner);
                }
                Err(FactorError::Pivot(column)) => failed = failed.or(Some(column)),
                Err(FactorError::Memory) => return Err(PreconditionError::Memory),
                Err(FactorError::Cancelled) => return Err(PreconditionError::Cancelled),
            }
        }
        Err(PreconditionError::Pivot(failed.unwrap_or_default()))
    }

    fn check(&self, system: &System) -> Result<(), PreconditionError> {
        let mut ones = self.extended(system, |_| 1.0);
        for (vertex, value) in ones.drain(..).enumerate() {
            let error = (value - 1.0).abs();
            if error.is_nan() || error > TOLERANCE {
                return Err(PreconditionError::Inaccurate(vertex, error));
            }
        }
        Ok(())
    }

    /// How many numbers the factor stores.
    pub fn stored(&self) -> usize {
        self.factor.stored()
    }

    /// x ← (−L)⁻¹ x.
    pub fn apply<const K: usize>(&self, x: &mut [[f64; K]]) {
        let rescale = |x: &mut [[f64; K]]| {
            x.par_iter_mut()
                .zip(&self.scale)
                .with_min_len(4 * CHUNK)
                .for_each(|(x, &scale)| *x = x.map(|value| value * scale));
        };
        rescale(x);
        self.factor.solve(x);
        rescale(x);
    }

    /// The harmonic function on the solved vertices with the values `of_constrained` on the constrained local ones.
    fn extended(&self, system: &System, of_constrained: impl Fn(u32) -> f64) -> Vec<f64> {
        let mut x = vec![[0.0]; self.scale.len()];
        for &(vertex, other, weight) in &system.constrained {
            x[vertex as usize][0] += weight * of_constrained(other);
        }
        self.apply(&mut x);
        x.into_iter().map(|[value]| value).collect()
    }

    /// Each handle's harmonic weight on each cell, row-major: 1 on its own vertices, 0 on other constrained ones.
    /// `handle_of` says which handle a local vertex belongs to; where `unheld` says that nothing is fixed around a
    /// local vertex, its weights sum to 1.
    pub fn weights(
        &self,
        system: &System,
        domain: &Domain,
        handle_count: usize,
        handle_of: impl Fn(u32) -> Option<usize>,
        unheld: impl Fn(u32) -> bool,
    ) -> Vec<f64> {
        let mut weights = vec![0.0; domain.cell_count * handle_count];
        for handle in 0..handle_count {
            let values = self.extended(system, |other| f64::from(handle_of(other) == Some(handle)));
            for (vertex, value) in values.into_iter().enumerate() {
                // Negative cotangents may carry it a little outside.
                weights[vertex * handle_count + handle] = value.clamp(0.0, 1.0);
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
        weights
    }
}
