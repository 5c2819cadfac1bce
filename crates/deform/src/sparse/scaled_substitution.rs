//! A factor of a scaled matrix S A S, laid out for many solves with A: A⁻¹ b = S (S A S)⁻¹ S b.

use rayon::prelude::*;

use super::cholesky::Factor;
use super::factor_error::FactorError;
use super::solve::rhs::{Real, Rhs};
use super::solve::substitution::{Scratch, Substitution};
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::CHUNKS_A_TASK;

/// The factor's numbers in the precision `T`, its scale, and memory that is kept from one solve to the next.
#[derive(Debug)]
pub(crate) struct ScaledSubstitution<T: Real> {
    substitution: Substitution<T>,
    scale: Vec<f64>,
    rows: Vec<Rhs<T>>,
    scratch: Scratch<T>,
}

impl<T: Real> ScaledSubstitution<T> {
    /// Copies a factor, whose matrix has this scale.
    ///
    /// # Errors
    /// [`FactorError::Memory`].
    pub fn of(factor: &Factor, scale: Vec<f64>) -> Result<Self, FactorError> {
        Ok(Self {
            substitution: factor.substitution()?,
            scale,
            rows: Vec::new(),
            scratch: Scratch::default(),
        })
    }

    /// The number of entries that the factor stores.
    pub fn stored(&self) -> usize {
        self.substitution.stored()
    }

    /// Solves for up to four right-hand sides at once: `read` gives those of an entry of `field`.
    pub fn solve<F: Sync>(&mut self, field: &[F], read: impl Fn(&F) -> [f64; 4] + Sync) {
        self.rows.resize(field.len(), Rhs::default());
        self.rows
            .par_chunks_mut(CHUNK)
            .zip(field.par_chunks(CHUNK))
            .zip(self.scale.par_chunks(CHUNK))
            .with_min_len(CHUNKS_A_TASK)
            .for_each(|((rows, field), scale)| {
                for ((row, value), &scale) in rows.iter_mut().zip(field).zip(scale) {
                    *row = read(value).map(|value| T::of(value * scale));
                }
            });
        self.substitution.solve(&mut self.rows, &mut self.scratch);
    }

    /// Writes the last solution to `field` by `write`.
    pub fn take<M: Send>(&self, field: &mut [M], write: impl Fn(&mut M, [f64; 4]) + Sync) {
        field
            .par_chunks_mut(CHUNK)
            .zip(self.rows.par_chunks(CHUNK))
            .zip(self.scale.par_chunks(CHUNK))
            .with_min_len(CHUNKS_A_TASK)
            .for_each(|((field, rows), scale)| {
                for ((value, row), &scale) in field.iter_mut().zip(rows).zip(scale) {
                    write(value, row.map(|entry| entry.wide() * scale));
                }
            });
    }
}
