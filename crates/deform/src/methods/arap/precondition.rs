//! The factored Laplacian: a global step, and the handles' harmonic weights.

use pliant_mesh::Cancel;

use super::cells::Quad;
use super::matrix::System;
use crate::budget::{Budget, filled};
use crate::coarse::domain::Domain;
use crate::sparse::cholesky::Factor;
use crate::sparse::factor_error::FactorError;
use crate::sparse::scaled_substitution::ScaledSubstitution;
use crate::sparse::solve::rhs::Real;
use crate::sparse::system_error::SystemError;

/// An approximate inverse of the system on the solved vertices.
///
/// It is kept in single precision if that is accurate enough for a descent direction, which halves the bytes to read,
/// and the next step corrects its rounding. Gradients and positions stay double.
#[derive(Debug)]
pub(crate) enum Preconditioner {
    Single(ScaledSubstitution<f32>),
    Double(ScaledSubstitution<f64>),
}

/// The largest allowed error of a constant's solution: accurate enough for a descent direction.
const TOLERANCE: f64 = 1e-2;

/// A factorisation's refusal, whose columns are the domain's vertices.
fn refused(error: FactorError, domain: &Domain) -> SystemError {
    SystemError::of(error, |local| domain.vertices[local])
}

impl Preconditioner {
    /// Factors and checks the system, whose supernodes end at `ends`; also returns each handle's weights (see
    /// [`handle_weights`]).
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
        let scale = &system.matrix.scale;
        let refuse = |error| refused(error, weights.domain);
        let mut double = ScaledSubstitution::of(factor, scale.clone()).map_err(refuse)?;
        let (vertex, error) = miss(&mut double, system);
        if error > TOLERANCE {
            let vertex = weights.domain.vertices[vertex];
            return Err(SystemError::Inaccurate { vertex, error });
        }
        let weights = handle_weights(&mut double, system, weights).map_err(refuse)?;
        cancel.check().map_err(|_| SystemError::Cancelled)?;
        let mut single = ScaledSubstitution::of(factor, scale.clone()).map_err(refuse)?;
        let (_, error) = miss(&mut single, system);
        let is_enough = error <= TOLERANCE;
        Ok((
            if is_enough {
                Self::Single(single)
            } else {
                Self::Double(double)
            },
            weights,
        ))
    }

    /// The number of entries that the factor stores.
    pub fn stored(&self) -> usize {
        match self {
            Self::Single(solver) => solver.stored(),
            Self::Double(solver) => solver.stored(),
        }
    }

    /// `mapped` ← the inverse of the system times `field`.
    pub fn map(&mut self, field: &[[f32; 3]], mapped: &mut [[f32; 3]]) {
        fn by<T: Real>(solver: &mut ScaledSubstitution<T>, field: &[[f32; 3]], mapped: &mut [[f32; 3]]) {
            solver.solve(field, |row| [row[0], row[1], row[2], 0.0].map(f64::from));
            solver.take(mapped, |mapped, row| {
                *mapped = [row[0], row[1], row[2]].map(|value| value as f32)
            });
        }
        match self {
            Self::Single(solver) => by(solver, field, mapped),
            Self::Double(solver) => by(solver, field, mapped),
        }
    }
}

/// The largest error of a constant, and its vertex.
fn miss<T: Real>(solver: &mut ScaledSubstitution<T>, system: &System) -> (usize, f64) {
    let ones = extended(solver, system, [|_: u32| 1.0; 1]);
    let error = |row: &Quad| {
        let error = (row[0] - 1.0).abs();
        if error.is_nan() { f64::INFINITY } else { error }
    };
    let errors = ones.iter().map(error).enumerate();
    errors.fold((0, 0.0), |worst, next| if next.1 > worst.1 { next } else { worst })
}

/// Up to four functions on the solved vertices for which the system's forces vanish, with the values
/// `of_constrained` on the constrained local ones.
fn extended<T: Real, const K: usize>(
    solver: &mut ScaledSubstitution<T>,
    system: &System,
    of_constrained: [impl Fn(u32) -> f64; K],
) -> Vec<Quad> {
    let mut values = vec![[0.0; 4]; system.matrix.scale.len()];
    for (k, constrained) in of_constrained.iter().enumerate().take(4) {
        for (own, pull) in values.iter_mut().zip(system.pull(constrained)) {
            own[k] = pull;
        }
    }
    solver.solve(&values, |row| *row);
    solver.take(&mut values, |value, row| *value = row);
    values
}

/// Each handle's weight on each cell, row-major: 1 on its own vertices, 0 on other constrained ones, harmonic in
/// the system's sense between. Around a vertex without a fixed one they sum to 1.
fn handle_weights(
    solver: &mut ScaledSubstitution<f64>,
    system: &System,
    input: &WeightInput<'_>,
) -> Result<Vec<f64>, FactorError> {
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
        let values = extended(solver, system, [of(0), of(1), of(2), of(3)]);
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
