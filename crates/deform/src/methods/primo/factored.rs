//! The factored Gauss–Newton matrix.

use pliant_mesh::Cancel;

use super::joints::Joints;
use super::pose::Pose;
use super::system::{DOF, gauss_newton};
use crate::budget::Budget;
use crate::sparse::cholesky::Factor;
use crate::sparse::factor_error::FactorError;

/// H⁻¹, approximately.
#[derive(Debug)]
pub(crate) struct Factored {
    factor: Factor,
    scale: Vec<f64>,
}

impl Factored {
    /// Factors the matrix at `pose`.
    ///
    /// # Errors
    /// Those of [`Factor::to_descend_by`]; a pivot is named by its prism.
    pub fn at(joints: &Joints, pose: &Pose, budget: Budget, cancel: &Cancel) -> Result<Self, FactorError> {
        let matrix = gauss_newton(joints, pose)?;
        let factor = Factor::to_descend_by(&matrix, &joints.column_ends(DOF), budget, cancel);
        let factor = factor.map_err(|error| match error {
            FactorError::Pivot(column) => FactorError::Pivot(column / DOF),
            other => other,
        })?;
        Ok(Self {
            factor,
            scale: matrix.scale,
        })
    }

    /// Factors the matrix at another pose; the old factor stays if that fails.
    pub fn renew(&mut self, joints: &Joints, pose: &Pose) {
        if let Ok(factored) = Self::at(joints, pose, Budget::default(), &Cancel::new()) {
            *self = factored;
        }
    }

    /// The number of entries that the factor stores.
    pub fn stored(&self) -> usize {
        self.factor.stored()
    }

    /// x ← H⁻¹ x.
    pub fn solve(&self, x: &mut [[f64; DOF]]) {
        let mut column: Vec<[f64; 1]> = x.as_flattened().iter().zip(&self.scale).map(|(x, s)| [x * s]).collect();
        self.factor.solve(&mut column);
        for ((x, [value]), scale) in x.as_flattened_mut().iter_mut().zip(column).zip(&self.scale) {
            *x = value * scale;
        }
    }
}
