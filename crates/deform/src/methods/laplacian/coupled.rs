//! The energy of implicit transformations, whose coordinates are coupled, and its matrix [SCL+04; BS08, section 3.2.6].
//!
//! T_i is linear in the displacements around i (see `similarity`), so the residual (L d)_i − (T_i − I)(L p)_i is
//! Σ_j G_ij (d_j − d_i) with 3×3 matrices G_ij, and
//!
//! E = ½ Σ_i c_i (|Σ_j G_ij (d_j − d_i)|² + ε |(L d)_i|²),  c_i = s_i / M_ii.
//!
//! ε is so small that it only decides motions that the handles leave open, such as a turn about a handle of one vertex.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::similarity::Similarity;
use crate::budget::{Budget, Limit, bytes_of, reserved};
use crate::numerical::rows::{CHUNK, place_in};
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::{CONSTRAINED, ScaledMatrix};
use crate::systems::operator::BilaplacianOperator;
use crate::systems::springs::Springs;

/// ε.
const FIRMNESS: f64 = 1e-6;

/// The unknowns of a vertex.
pub(super) const DOF: usize = 3;

/// Bytes of an entry of the matrix: its row and its value.
const ENTRY: usize = 12;

/// The energy over the operator's local vertices.
pub(super) struct CoupledEnergy<'a> {
    pub operator: &'a BilaplacianOperator,
    /// The soft handles' springs, which are the operator's first ones.
    pub springs: Springs,
    /// G of each entry of the Laplacian's full rows.
    entries: Vec<DMat3>,
    /// The start of each local vertex' entries.
    offsets: Vec<usize>,
}

impl<'a> CoupledEnergy<'a> {
    /// The energy for the rest positions of the local vertices, their fits and their `curvature` L p, with the first
    /// `spring_count` springs of the operator.
    ///
    /// # Errors
    /// [`FactorError::Memory`].
    pub fn of(
        operator: &'a BilaplacianOperator,
        spring_count: usize,
        similarities: &[Similarity],
        rest: &[DVec3],
        curvature: &[DVec3],
    ) -> Result<Self, FactorError> {
        let laplacian = &operator.laplacian;
        let count = laplacian.vertices().len();
        let mut offsets = vec![0];
        for local in 0..count {
            offsets.push(offsets[local] + laplacian.neighbours(local).len());
        }
        let mut entries = reserved(offsets[count])?;
        for local in 0..count {
            let around = laplacian.neighbours(local).iter().zip(laplacian.weights(local));
            entries.extend(around.map(|(&other, &weight)| {
                let edge = rest[other as usize] - rest[local];
                DMat3::from_diagonal(DVec3::splat(weight)) - similarities[local].effect_on(curvature[local], edge)
            }));
        }
        Ok(Self {
            operator,
            springs: operator.springs.first(spring_count, count),
            entries,
            offsets,
        })
    }

    /// c_i. It is 0 at hubs, whose residual would couple all their neighbours with each other: their surroundings hold
    /// them.
    pub fn density(&self, local: usize) -> f64 {
        if self.operator.laplacian.neighbours(local).len() > self.operator.hub_degree {
            return 0.0;
        }
        self.operator.cell_stiffness(local) * self.operator.laplacian.inverse_areas()[local]
    }

    /// G for a local vertex' neighbours.
    pub fn around(&self, local: usize) -> &[DMat3] {
        &self.entries[self.offsets[local]..self.offsets[local + 1]]
    }

    /// The coefficients of the residual at `local`: for its neighbours' displacements and, last, for its own; each with
    /// w, for ε.
    fn row(&self, local: usize) -> impl Iterator<Item = (u32, DMat3, f64)> + '_ {
        let laplacian = &self.operator.laplacian;
        let (others, weights) = (laplacian.neighbours(local), laplacian.weights(local));
        let own: DMat3 = self.around(local).iter().fold(DMat3::ZERO, |sum, g| sum - *g);
        let own = (local as u32, own, -weights.iter().sum::<f64>());
        let beside = others.iter().zip(self.around(local)).zip(weights);
        beside
            .map(|((&other, &g), &weight)| (other, g, weight))
            .chain(std::iter::once(own))
    }

    /// Its matrix over the local vertices `locals`, in that order, each with three columns; `column_of` is the inverse
    /// table.
    ///
    /// # Errors
    /// The matrix exceeds the budget or the machine's memory.
    pub fn assemble(&self, locals: &[u32], column_of: &[u32], budget: Budget) -> Result<ScaledMatrix, FactorError> {
        let laplacian = &self.operator.laplacian;
        // This is the maximum: every pair of a ring, the vertex itself included.
        let ring = |local: u32| match self.density(local as usize) {
            0.0 => 0,
            _ => laplacian.neighbours(local as usize).len() + 1,
        };
        let most = |local: &u32| {
            let around = laplacian.neighbours(*local as usize).iter();
            around.map(|&other| ring(other)).sum::<usize>() + ring(*local)
        };
        let bytes = bytes_of(locals.iter().map(most).sum(), DOF * DOF * ENTRY);
        if bytes > budget.bytes {
            return Err(FactorError::Budget(Limit::Bytes(budget.bytes)));
        }
        let chunks: Vec<Vec<Vec<(u32, DMat3)>>> = (0..locals.len().div_ceil(CHUNK))
            .into_par_iter()
            .map_init(
                || vec![0_u32; column_of.len()],
                |slots, chunk| {
                    let range = chunk * CHUNK..((chunk + 1) * CHUNK).min(locals.len());
                    range
                        .map(|column| self.column(locals[column], column as u32, column_of, slots))
                        .collect()
                },
            )
            .collect();
        let columns = || chunks.iter().flatten();
        let blocks: usize = columns().map(Vec::len).sum();
        let entries = blocks * DOF * DOF;
        u32::try_from(entries).map_err(|_| FactorError::Memory)?;
        let mut matrix = ScaledMatrix {
            scale: reserved(DOF * locals.len())?,
            lower_offsets: reserved(DOF * locals.len() + 1)?,
            lower_rows: reserved(entries)?,
            lower_values: reserved(entries)?,
        };
        matrix.lower_offsets.push(0);
        for (column, blocks) in columns().enumerate() {
            for k in 0..DOF {
                // The vertex's own block comes first: its part below the diagonal.
                let own = blocks[0].1.col(k);
                for l in k..DOF {
                    matrix.lower_rows.push((DOF * column + l) as u32);
                    matrix.lower_values.push(own[l]);
                }
                for (row, block) in &blocks[1..] {
                    let values = block.col(k);
                    for l in 0..DOF {
                        matrix.lower_rows.push(DOF as u32 * row + l as u32);
                        matrix.lower_values.push(values[l]);
                    }
                }
                matrix.lower_offsets.push(matrix.lower_rows.len() as u32);
                matrix
                    .scale
                    .push(if own[k] > 0.0 { own[k].sqrt().recip() } else { 1.0 });
            }
        }
        matrix.scale_values();
        Ok(matrix)
    }

    /// The blocks of a vertex' column on and below the diagonal, its own first: Σ_i c_i (C_iuᵀ C_iv + ε w_iu w_iv I).
    fn column(&self, local: u32, column: u32, column_of: &[u32], slots: &mut [u32]) -> Vec<(u32, DMat3)> {
        let laplacian = &self.operator.laplacian;
        let spring = DMat3::from_diagonal(DVec3::splat(self.springs.diagonal(local)));
        let mut blocks = vec![(column, spring)];
        slots[local as usize] = 1;
        let mut touched = vec![local];
        for &middle in laplacian
            .neighbours(local as usize)
            .iter()
            .chain(std::iter::once(&local))
        {
            let density = self.density(middle as usize);
            if density == 0.0 {
                continue;
            }
            let own = if middle == local {
                self.row(middle as usize).last()
            } else {
                place_in(laplacian.neighbours(middle as usize), &local).map(|place| {
                    (
                        local,
                        self.around(middle as usize)[place],
                        laplacian.weights(middle as usize)[place],
                    )
                })
            };
            let Some((_, c, w)) = own else { continue };
            for (far, other, weight) in self.row(middle as usize) {
                let row = column_of[far as usize];
                if row == CONSTRAINED || row < column {
                    continue;
                }
                let slot = &mut slots[far as usize];
                if *slot == 0 {
                    blocks.push((row, DMat3::ZERO));
                    *slot = blocks.len() as u32;
                    touched.push(far);
                }
                let firm = DMat3::from_diagonal(DVec3::splat(FIRMNESS * weight * w));
                blocks[*slot as usize - 1].1 += (other.transpose() * c + firm) * density;
            }
        }
        touched.iter().for_each(|&far| slots[far as usize] = 0);
        blocks
    }

    /// c_i times the residual and c_i ε (L d)_i, for each local vertex.
    pub fn stress<const K: usize>(&self, d: &[[f64; K]]) -> Vec<[[DVec3; 2]; K]> {
        let laplacian = &self.operator.laplacian;
        let at = |local: usize, k: usize| DVec3::new(d[3 * local][k], d[3 * local + 1][k], d[3 * local + 2][k]);
        (0..laplacian.vertices().len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|local| {
                let density = self.density(local);
                let around = || {
                    let beside = laplacian.neighbours(local).iter().zip(laplacian.weights(local));
                    beside.zip(self.around(local))
                };
                std::array::from_fn(|k| {
                    let (mut residual, mut bend) = (DVec3::ZERO, DVec3::ZERO);
                    for ((&other, &weight), g) in around() {
                        let change = at(other as usize, k) - at(local, k);
                        residual += *g * change;
                        bend += change * weight;
                    }
                    [residual * density, bend * (density * FIRMNESS)]
                })
            })
            .collect()
    }
}
