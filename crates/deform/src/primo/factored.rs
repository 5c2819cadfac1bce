//! The factored Gauss–Newton matrix, and the handles' harmonic weights.

use pliant_mesh::Cancel;

use super::joints::Joints;
use super::pose::Pose;
use super::system::{DOF, gauss_newton, laplacian};
use crate::sparse::cholesky::Factor;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::ScaledMatrix;

/// H⁻¹, or nearly so.
#[derive(Debug)]
pub(crate) struct Factored {
    factor: Factor,
    scale: Vec<f64>,
}

/// What is added to the unit diagonal until it can be factored. Steps get shorter by it; results stay the same.
const SHIFTS: [f64; 6] = [0.0, 1e-13, 1e-11, 1e-9, 1e-7, 1e-5];

impl Factored {
    /// Factors the matrix at `pose`.
    ///
    /// # Errors
    /// As [`Factor::of`]; a pivot is named by its prism.
    pub fn at(joints: &Joints, pose: &Pose, cancel: &Cancel) -> Result<Self, FactorError> {
        let matrix = gauss_newton(joints, pose);
        let factor = factor(&matrix, &joints.column_ends(DOF), cancel).map_err(|error| match error {
            FactorError::Pivot(column) => FactorError::Pivot(column / DOF),
            other => other,
        })?;
        Ok(Self {
            factor,
            scale: matrix.scale,
        })
    }

    /// Factors the matrix at another pose; the old factor stays where that fails.
    pub fn renew(&mut self, joints: &Joints, pose: &Pose) {
        if let Ok(factored) = Self::at(joints, pose, &Cancel::new()) {
            *self = factored;
        }
    }

    /// How many numbers the factor stores.
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

/// The factored Laplacian of the couplings: prisms as points on springs.
#[derive(Debug)]
pub(crate) struct Springs {
    factor: Factor,
    scale: Vec<f64>,
}

impl Springs {
    pub fn of(joints: &Joints, cancel: &Cancel) -> Result<Self, FactorError> {
        let matrix = laplacian(joints);
        Ok(Self {
            factor: factor(&matrix, &joints.column_ends(1), cancel)?,
            scale: matrix.scale,
        })
    }

    /// x ← L⁻¹ x.
    pub fn apply<const K: usize>(&self, x: &mut [[f64; K]]) {
        let rescale = |x: &mut [[f64; K]]| {
            for (x, scale) in x.iter_mut().zip(&self.scale) {
                *x = x.map(|value| value * scale);
            }
        };
        rescale(x);
        self.factor.solve(x);
        rescale(x);
    }

    /// Each handle's harmonic weight on each solved prism, row-major: 1 on its own prisms, 0 on other grounds. Where
    /// `unheld` says that nothing is fixed around a prism its weights sum to 1.
    pub fn weights(&self, joints: &Joints, handle_count: usize, unheld: impl Fn(usize) -> bool) -> Vec<f64> {
        let count = joints.count();
        let mut weights = vec![0.0; count * handle_count];
        for handle in 0..handle_count {
            let ground = (count + 1 + handle) as u32;
            let mut x: Vec<[f64; 1]> = (0..count)
                .map(|prism| {
                    let sides = joints.sides(prism).iter().filter(|side| side.other == ground);
                    [sides.map(|side| side.weight).sum::<f64>()]
                })
                .collect();
            self.apply(&mut x);
            for (prism, [value]) in x.into_iter().enumerate() {
                weights[prism * handle_count + handle] = if value.is_finite() { value.clamp(0.0, 1.0) } else { 0.0 };
            }
        }
        for (prism, weights) in weights.chunks_exact_mut(handle_count.max(1)).enumerate() {
            let sum: f64 = weights.iter().sum();
            if sum > 0.0 && unheld(prism) {
                for weight in weights {
                    *weight /= sum;
                }
            }
        }
        weights
    }
}

fn factor(matrix: &ScaledMatrix, ends: &[u32], cancel: &Cancel) -> Result<Factor, FactorError> {
    let mut failed = None;
    for shift in SHIFTS {
        if cancel.is_cancelled() {
            return Err(FactorError::Cancelled);
        }
        match Factor::of(matrix, ends, shift, cancel) {
            Err(FactorError::Pivot(column)) => failed = failed.or(Some(column)),
            other => return other,
        }
    }
    Err(FactorError::Pivot(failed.unwrap_or_default()))
}
