//! The Gauss–Newton matrix: a constant part, the same for each row of the maps, and each node's rigidity. Its pattern is
//! analysed once.

use std::collections::BTreeMap;

use glam::DMat3;
use pliant_mesh::Cancel;

use super::energy::{DOF, Energy, NodeMap};
use super::graph::Graph;
use crate::Budget;
use crate::budget::{bytes_of, filled};
use crate::sparse::cholesky::Factor;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::ScaledMatrix;

/// The values added to the unit diagonal, one after the other, until a factor exists.
const SHIFTS: [f64; 3] = [1e-12, 1e-9, 1e-6];

/// Bytes of a pair of nodes in the table that the matrix is made from, and of an entry of the matrix with its constant
/// part.
const BLOCK: usize = 160;
const ENTRY: usize = size_of::<u32>() + 2 * size_of::<f64>();

/// JᵀJ and its factor.
#[derive(Debug)]
pub(super) struct System {
    matrix: ScaledMatrix,
    /// The values of the constant part, unscaled.
    constant: Vec<f64>,
    factor: Factor,
}

impl System {
    /// Analyses the matrix.
    ///
    /// # Errors
    /// The matrix exceeds the budget or the machine's memory.
    pub fn of(energy: &Energy, graph: &Graph, budget: Budget) -> Result<Self, FactorError> {
        // The factors' products by column and row of nodes.
        let mut blocks: BTreeMap<(u32, u32), [[f64; 4]; 4]> = BTreeMap::new();
        for node in 0..energy.count() as u32 {
            blocks.insert((node, node), [[0.0; 4]; 4]);
        }
        energy.equations(|row, weight| {
            for (one, factors) in row {
                for (other, others) in row.iter().filter(|(other, _)| other >= one) {
                    let block = blocks.entry((*one, *other)).or_default();
                    for (sums, b) in block.iter_mut().zip(others) {
                        for (sum, a) in sums.iter_mut().zip(factors) {
                            *sum += weight * a * b;
                        }
                    }
                }
            }
        });
        let size = DOF * energy.count();
        let below = blocks.len() - energy.count();
        let entries = energy.count() * DOF * (DOF + 1) / 2 + below * DOF * DOF;
        u32::try_from(entries).map_err(|_| FactorError::Memory)?;
        let budget = budget
            .without(bytes_of(blocks.len(), BLOCK))
            .map_err(FactorError::Budget)?;
        let budget = budget.without(bytes_of(entries, ENTRY)).map_err(FactorError::Budget)?;
        let mut matrix = ScaledMatrix {
            scale: filled(1.0, size)?,
            lower_offsets: vec![0],
            lower_rows: Vec::with_capacity(entries),
            lower_values: Vec::with_capacity(entries),
        };
        for node in 0..energy.count() as u32 {
            let own: Vec<_> = blocks.range((node, 0)..=(node, u32::MAX)).collect();
            for k in 0..DOF {
                for &(&(_, row), block) in &own {
                    let first = if row == node { k } else { 0 };
                    for l in first..DOF {
                        let value = if l / 4 == k / 4 { block[l % 4][k % 4] } else { 0.0 };
                        matrix.lower_rows.push(DOF as u32 * row + l as u32);
                        matrix.lower_values.push(value);
                    }
                }
                matrix.lower_offsets.push(matrix.lower_rows.len() as u32);
            }
        }
        let ends: Vec<u32> = graph.ends.iter().map(|end| DOF as u32 * end).collect();
        Ok(Self {
            constant: matrix.lower_values.clone(),
            factor: Factor::analysed(&matrix, &ends, budget)?,
            matrix,
        })
    }

    /// The number of entries that the factor stores.
    pub fn stored(&self) -> usize {
        self.factor.stored()
    }

    /// Fills in the matrix at these maps and factors it.
    ///
    /// # Errors
    /// The matrix is not positive definite, even with the largest addition to its diagonal.
    pub fn factor(&mut self, energy: &Energy, maps: &[NodeMap]) -> Result<(), FactorError> {
        let matrix = &mut self.matrix;
        matrix.lower_values.copy_from_slice(&self.constant);
        for (node, (map, rigidity)) in maps.iter().zip(&energy.rigidity).enumerate() {
            let own = rigidity_block(&(map.linear + DMat3::IDENTITY), *rigidity);
            for k in 0..DOF {
                let start = matrix.lower_offsets[DOF * node + k] as usize;
                for l in k..DOF {
                    matrix.lower_values[start + l - k] += own[l][k];
                }
            }
        }
        for (column, scale) in matrix.scale.iter_mut().enumerate() {
            let diagonal = matrix.lower_values[matrix.lower_offsets[column] as usize];
            *scale = if diagonal > 0.0 { diagonal.sqrt().recip() } else { 1.0 };
        }
        matrix.scale_values();
        let mut refused = FactorError::Memory;
        for shift in SHIFTS {
            match self.factor.fill(&self.matrix, shift, &Cancel::new()) {
                Ok(()) => return Ok(()),
                Err(error) => refused = error,
            }
        }
        Err(refused)
    }

    /// (JᵀJ)⁻¹ x.
    pub fn solve(&self, x: &[[f64; DOF]]) -> Vec<[f64; DOF]> {
        let scale = &self.matrix.scale;
        let mut column: Vec<[f64; 1]> = x.as_flattened().iter().zip(scale).map(|(x, s)| [x * s]).collect();
        self.factor.solve(&mut column);
        let mut solution = vec![[0.0; DOF]; x.len()];
        for ((out, [value]), scale) in solution.as_flattened_mut().iter_mut().zip(column).zip(scale) {
            *out = value * scale;
        }
        solution
    }
}

/// JᵀJ of ρ ‖AᵀA − I‖²: dG_ij = da_i · a_j + a_i · da_j for A's columns a.
fn rigidity_block(a: &DMat3, rigidity: f64) -> [[f64; DOF]; DOF] {
    let mut block = [[0.0; DOF]; DOF];
    for i in 0..3 {
        for j in i..3 {
            let mut row = [0.0; DOF];
            for k in 0..3 {
                row[4 * k + i] += a.col(j)[k];
                row[4 * k + j] += a.col(i)[k];
            }
            let weight = if i == j { rigidity } else { 2.0 * rigidity };
            for (sums, b) in block.iter_mut().zip(row) {
                for (sum, a) in sums.iter_mut().zip(row) {
                    *sum += weight * a * b;
                }
            }
        }
    }
    block
}
