//! Prisms as points on springs: the scalar Laplacian of their couplings, and the handles' harmonic weights.

use pliant_mesh::Cancel;

use super::joints::Joints;
use crate::budget::{Budget, filled, reserved};
use crate::sparse::cholesky::Factor;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::ScaledMatrix;

/// The factored Laplacian of the couplings: prisms as points on springs.
#[derive(Debug)]
pub(crate) struct Springs {
    factor: Factor,
    scale: Vec<f64>,
}

impl Springs {
    pub fn of(joints: &Joints, budget: Budget, cancel: &Cancel) -> Result<Self, FactorError> {
        let matrix = laplacian(joints)?;
        Ok(Self {
            factor: Factor::to_descend_by(&matrix, &joints.column_ends(1), budget, cancel)?,
            scale: matrix.scale,
        })
    }

    /// The number of entries that the factor stores.
    pub fn stored(&self) -> usize {
        self.factor.stored()
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

    /// Each handle's harmonic weight on each solved prism, row-major: 1 on its own prisms, 0 on other grounds. If
    /// `unheld` says that nothing is fixed around a prism, its weights sum to 1.
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

/// The matrix of Σ w_ij (u_i − u_j)², scaled to a unit diagonal, for solving for harmonic weights.
fn laplacian(joints: &Joints) -> Result<ScaledMatrix, FactorError> {
    let sides: usize = (0..joints.count()).map(|prism| joints.sides(prism).len()).sum();
    let most = joints.count() + sides;
    let mut matrix = ScaledMatrix {
        scale: reserved(joints.count())?,
        lower_offsets: reserved(joints.count() + 1)?,
        lower_rows: reserved(most)?,
        lower_values: reserved(most)?,
    };
    matrix.lower_offsets.push(0);
    // One more than the place of a row in the present column, for the rows in it.
    let mut places = filled(0, joints.count())?;
    for prism in 0..joints.count() {
        let start = matrix.lower_rows.len();
        matrix.lower_rows.push(prism as u32);
        matrix.lower_values.push(0.0);
        for side in joints.sides(prism) {
            matrix.lower_values[start] += side.weight;
            if !(prism + 1..joints.count()).contains(&(side.other as usize)) {
                continue;
            }
            let place = &mut places[side.other as usize];
            if *place > start + 1 {
                matrix.lower_values[*place - 1] -= side.weight;
            } else {
                matrix.lower_rows.push(side.other);
                matrix.lower_values.push(-side.weight);
                *place = matrix.lower_rows.len();
            }
        }
        let diagonal = matrix.lower_values[start];
        matrix
            .scale
            .push(if diagonal > 0.0 { diagonal.sqrt().recip() } else { 1.0 });
        matrix.lower_offsets.push(matrix.lower_rows.len() as u32);
    }
    matrix.scale_values();
    Ok(matrix)
}
