//! The factored system of implicit transformations.
//!
//! A vertex' three unknowns are eliminated together, so the bi-Laplacian's order is suitable. The system is solved at
//! binding alone: a frame is a product with the solutions (see `bases`).

use glam::DVec3;
use pliant_mesh::Cancel;
use rayon::prelude::*;

use super::coupled::{CoupledEnergy, DOF};
use crate::budget::Budget;
use crate::numerical::rows::{CHUNK, place_in};
use crate::sparse::Elimination;
use crate::sparse::cholesky::Factor;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::CONSTRAINED;
use crate::systems::refine::{Outcome, Refined, missed_constant, solve_for_frames, solve_fully};

/// The factored system. A field has three rows for each place of the operator's: x, y and z.
pub(super) struct ImplicitSystem<'a> {
    energy: CoupledEnergy<'a>,
    /// The row of each column.
    places: Vec<u32>,
    /// The column of each row.
    column_of: Vec<u32>,
    /// The first column of each spring's vertex.
    spring_columns: Vec<u32>,
    factor: Factor,
    scale: Vec<f64>,
    contraction: f64,
}

impl<'a> ImplicitSystem<'a> {
    /// Assembles and factors in this order of elimination.
    ///
    /// # Errors
    /// A factorisation's errors; a pivot is named by its local vertex.
    pub fn of(
        energy: CoupledEnergy<'a>,
        elimination: &Elimination,
        budget: Budget,
        cancel: &Cancel,
    ) -> Result<Self, FactorError> {
        let laplacian = &energy.operator.laplacian;
        let locals = laplacian.locals(&elimination.order);
        let mut column_of = vec![CONSTRAINED; laplacian.vertices().len()];
        for (column, &local) in locals.iter().enumerate() {
            column_of[local as usize] = column as u32;
        }
        let matrix = energy.assemble(&locals, &column_of, budget)?;
        cancel.check().map_err(|_| FactorError::Cancelled)?;
        let ends: Vec<u32> = elimination.ends.iter().map(|end| DOF as u32 * end).collect();
        let factor = Factor::to_descend_by(&matrix, &ends, budget, cancel).map_err(|error| match error {
            FactorError::Pivot(column) => FactorError::Pivot(locals[column / DOF] as usize),
            other => other,
        })?;
        let springs = energy.springs.locals().iter();
        Ok(Self {
            places: locals
                .iter()
                .flat_map(|local| [0, 1, 2].map(|k| 3 * local + k))
                .collect(),
            spring_columns: springs.map(|&local| 3 * column_of[local as usize]).collect(),
            column_of: column_of
                .iter()
                .flat_map(|&column| {
                    [0, 1, 2].map(|k| match column {
                        CONSTRAINED => CONSTRAINED,
                        column => 3 * column + k,
                    })
                })
                .collect(),
            energy,
            factor,
            scale: matrix.scale,
            contraction: 0.0,
        })
    }

    /// Solves for a translation, whose solution is known: returns the largest error, and its local vertex.
    pub fn check(&mut self, cancel: &Cancel) -> (f64, u32) {
        let mut d = vec![[1.0]; self.field_len()];
        self.contraction = solve_fully(self, &mut d, 0.0, cancel).contraction;
        let (missed, place) = missed_constant(self, &d);
        (missed, place / DOF as u32)
    }

    /// Fills in the solved rows of K functions.
    pub fn solve<const K: usize>(&self, d: &mut [[f64; K]], cancel: &Cancel) -> Outcome {
        solve_for_frames(self, d, self.contraction, cancel)
    }
}

impl Refined for ImplicitSystem<'_> {
    fn places(&self) -> &[u32] {
        &self.places
    }

    fn column_of(&self) -> &[u32] {
        &self.column_of
    }

    fn field_len(&self) -> usize {
        DOF * self.energy.operator.field_len()
    }

    fn scale(&self) -> &[f64] {
        &self.scale
    }

    fn scaled_residual<const K: usize>(&self, d: &[[f64; K]]) -> Vec<[f64; K]> {
        let laplacian = &self.energy.operator.laplacian;
        let springs = &self.energy.springs;
        let stress = self.energy.stress(d);
        let mut residual = vec![[0.0; K]; self.places.len()];
        residual
            .par_chunks_mut(DOF)
            .zip(self.places.par_chunks(DOF))
            .with_min_len(CHUNK)
            .for_each(|(rows, places)| {
                let local = places[0] as usize / DOF;
                for k in 0..K {
                    let mut force = DVec3::ZERO;
                    let [own, own_bend] = stress[local][k];
                    let beside = laplacian.neighbours(local).iter().zip(laplacian.weights(local));
                    for ((&other, &weight), g) in beside.zip(self.energy.around(local)) {
                        let [_, bend] = stress[other as usize][k];
                        force += g.transpose() * own + (own_bend - bend) * weight;
                        let back = place_in(laplacian.neighbours(other as usize), &(local as u32));
                        if let Some(back) = back {
                            force -=
                                self.energy.around(other as usize)[back].transpose() * stress[other as usize][k][0];
                        }
                    }
                    for (component, row) in rows.iter_mut().enumerate() {
                        row[k] = force[component];
                    }
                }
            });
        for (spring, &column) in self.spring_columns.iter().enumerate() {
            let anchor = laplacian.vertices().len() + spring;
            let local = springs.local(spring) as usize;
            for component in 0..DOF {
                for k in 0..K {
                    let apart = d[DOF * anchor + component][k] - d[DOF * local + component][k];
                    residual[column as usize + component][k] += springs.strength(spring) * apart;
                }
            }
        }
        for (row, scale) in residual.iter_mut().zip(&self.scale) {
            row.iter_mut().for_each(|value| *value *= scale);
        }
        residual
    }

    fn solve_factored<const K: usize>(&self, x: &mut [[f64; K]], _left: f64, _cancel: &Cancel) {
        self.factor.solve(x);
    }
}
