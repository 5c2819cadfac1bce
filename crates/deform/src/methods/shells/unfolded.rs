//! The energy of the unfolded surface, which is quadratic and the same for the three coordinates:
//!
//! ½ Σ_e k_s s_e A_e (x_a − x_b)² / l̄² + ½ Σ_e k_b D² s_e l̄² (Σ_i f_i x_i)² / A_e
//!
//! with the linear angle's factors f (`hinge::flat`): a thin plate on a membrane. Its matrix is at least that of the
//! edges and hinges in JᵀJ where the surface is about flat. The handles' weights minimise it: each is the share of a
//! handle's motion with which a vertex starts. Constants cost nothing, so the weights sum to 1 if nothing is fixed. A
//! large surface's steps descend on top of its factor, and the factor transfers the motion of the coarse level
//! (`carry`).
//!
//! Areas are omitted: edges 1.5 times as stiff would outweigh them too, but with these the steps of a scan of 43k
//! vertices lowered the energy as much as without.

use pliant_mesh::{Cancel, SurfaceVertex};

use super::elements::Hinge;
use super::hinge::flat;
use super::shape::Energy;
use super::system::{Pattern, scale};
use crate::Role;
use crate::budget::Budget;
use crate::numerical::rows::place_in;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;
use crate::sparse::cholesky::Factor;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::ScaledMatrix;
use crate::sparse::scaled_substitution::ScaledSubstitution;

/// The factor of the unfolded energy's matrix on the solved vertices.
#[derive(Debug)]
pub(super) struct Unfolded {
    factor: Factor,
    scale: Vec<f64>,
}

/// The same in single precision and laid out for many solves: accurate enough for a direction.
#[derive(Debug)]
pub(super) struct Preconditioner(ScaledSubstitution<f32>);

impl Unfolded {
    /// Factors the matrix, with supernodes that end at `ends`.
    ///
    /// # Errors
    /// The errors of a factorisation; a pivot is named by its local vertex.
    pub fn of(
        energy: &Energy,
        pattern: &Pattern,
        ends: &[u32],
        budget: Budget,
        cancel: &Cancel,
    ) -> Result<Self, FactorError> {
        let matrix = assembled(energy, pattern)?;
        Ok(Self {
            factor: Factor::to_descend_by(&matrix, ends, budget, cancel)?,
            scale: matrix.scale,
        })
    }

    /// Copies it in single precision.
    ///
    /// # Errors
    /// [`FactorError::Memory`].
    pub fn preconditioner(self) -> Result<Preconditioner, FactorError> {
        ScaledSubstitution::of(&self.factor, self.scale).map(Preconditioner)
    }

    /// Each handle's weight at each solved vertex, from 0 to 1, in rows.
    ///
    /// # Errors
    /// [`FactorError::Cancelled`].
    pub fn weights(
        &self,
        problem: &BoundaryProblem,
        partition: &Partition,
        energy: &Energy,
        cancel: &Cancel,
    ) -> Result<Vec<f64>, FactorError> {
        let handle_count = partition.handles.len();
        let solved_count = energy.elements.solved_count;
        let mut weights = vec![0.0; solved_count * handle_count];
        // The hard handle that holds a local vertex.
        let handle_of = |local: u32| match problem.roles[energy.elements.vertices[local as usize] as usize] {
            Role::Handle(handle) => Some(usize::from(handle)).filter(|&handle| partition.soft[handle].is_none()),
            Role::Fixed | Role::Free => None,
        };
        let mut pulls = Vec::new();
        each_square(energy, |corners, factors, weight| {
            let factored = || corners.iter().zip(factors);
            for (&row, own) in factored().filter(|(row, _)| (**row as usize) < solved_count) {
                for (&other, factor) in factored().filter(|(other, _)| (**other as usize) >= solved_count) {
                    pulls.extend(handle_of(other).map(|handle| (handle, row, -weight * own * factor)));
                }
            }
        });
        let springs = energy.springs.all().iter();
        pulls.extend(springs.map(|spring| (spring.handle, spring.local, spring.strength)));
        pulls.sort_by_key(|&(handle, row, _)| (handle, row));
        for own in pulls.chunk_by(|one, other| one.0 == other.0) {
            cancel.check().map_err(|_| FactorError::Cancelled)?;
            let mut column = vec![[0.0]; solved_count];
            for &(_, row, pull) in own {
                column[row as usize][0] += pull * self.scale[row as usize];
            }
            self.factor.solve(&mut column);
            let handle = own[0].0;
            for (row, [value]) in column.into_iter().enumerate() {
                let value = value * self.scale[row];
                weights[row * handle_count + handle] = if value.is_finite() { value.clamp(0.0, 1.0) } else { 0.0 };
            }
        }
        let vertices = &energy.elements.vertices[..solved_count];
        for (own, &vertex) in weights.chunks_exact_mut(handle_count.max(1)).zip(vertices) {
            let is_held = partition.held[problem.topology.component(SurfaceVertex(vertex)) as usize];
            let sum: f64 = own.iter().sum();
            if sum > 1.0 || sum > 0.0 && !is_held {
                own.iter_mut().for_each(|weight| *weight /= sum);
            }
        }
        Ok(weights)
    }
}

impl Preconditioner {
    /// The count of numbers of 8 bytes that it stores.
    pub fn stored(&self) -> usize {
        self.0.stored() / 2
    }

    /// x ← A⁻¹ x.
    pub fn apply(&mut self, x: &mut [[f64; 3]]) {
        self.0.solve(x, |x| [x[0], x[1], x[2], 0.0]);
        self.0.take(x, |x, row| *x = [row[0], row[1], row[2]]);
    }
}

/// Visits each square ½ weight (Σ f w)²: its vertices, its factors f and its weight.
fn each_square(energy: &Energy, mut take: impl FnMut(&[u32], &[f64], f64)) {
    let elements = &energy.elements;
    for edge in &elements.edges {
        take(&edge.ends, &[1.0, -1.0], edge.weight);
    }
    for Hinge { corners, weight, .. } in &elements.hinges {
        let factors = flat(corners.map(|corner| elements.rest[corner as usize]));
        take(corners, &factors, *weight);
    }
}

fn assembled(energy: &Energy, pattern: &Pattern) -> Result<ScaledMatrix, FactorError> {
    let count = pattern.count();
    let mut matrix = pattern.matrix(1)?;
    each_square(energy, |corners, factors, weight| {
        for (&column, own) in corners
            .iter()
            .zip(factors)
            .filter(|(column, _)| (**column as usize) < count)
        {
            let rows = pattern.rows(column as usize);
            let below = corners.iter().zip(factors).filter(|(row, _)| **row >= column);
            for (row, factor) in below {
                if let Some(place) = place_in(rows, row) {
                    let entry = matrix.lower_offsets[column as usize] as usize + place;
                    matrix.lower_values[entry] += weight * own * factor;
                }
            }
        }
    });
    for (local, more) in energy.on_diagonal() {
        let diagonal = matrix.lower_offsets[local as usize];
        matrix.lower_values[diagonal as usize] += more;
    }
    scale(&mut matrix);
    Ok(matrix)
}
