//! The bound bi-Laplacian: A_ff d_f = −A_fc d_c, factored, refined and checked.
//!
//! That a factorisation succeeds proves nothing: condition numbers reach 1e15 on real scans. So every solve is refined
//! (see `refine`), and every binding also solves for the constant 1, whose solution is known, and is refused if the
//! result is wrong.

use std::sync::Arc;

use pliant_mesh::Cancel;
use rayon::prelude::*;

use crate::budget::{Budget, Limit, bytes_of};
use crate::numerical::rows::CHUNK;
use crate::sparse::Elimination;
use crate::sparse::factor_error::FactorError;
use crate::sparse::low_rank::LowRank;
use crate::sparse::matrix::CONSTRAINED;
use crate::sparse::refactorisation::{Refactorisation, RenewableFactor};
use crate::sparse::system_error::SystemError;
use crate::systems::assembly::assemble_bilaplacian;
use crate::systems::capacitance::Capacitance;
use crate::systems::elimination_plan::EliminationPlan;
use crate::systems::held::HeldReach;
use crate::systems::hubs::Hubs;
use crate::systems::operator::BilaplacianOperator;
use crate::systems::solution::Solution;

/// The factored system over the local vertices of its Laplacian.
#[derive(Debug)]
pub(crate) struct BilaplacianSystem {
    pub operator: BilaplacianOperator,
    /// The local vertex of each column of the factor.
    columns: Vec<u32>,
    column_of: Vec<u32>,
    held_reach: Option<HeldReach>,
    /// The column of each of the operator's springs.
    spring_columns: Vec<u32>,
    solution: Solution,
    /// The rate at which refinement converged at the check: see [`crate::systems::refine`].
    pub(crate) contraction: f64,
}

/// Shifts of the unit diagonal that are tried one after the other. Refinement with the unshifted operator removes their
/// effect again; the check of the constant proves it.
const SHIFTS: [f64; 4] = [0.0, 1e-13, 1e-11, 1e-9];

impl BilaplacianSystem {
    /// Factors the system that solves for the vertices of `elimination`, eliminated in that order; the operator's
    /// Laplacian has full rows for them and their neighbours.
    pub fn new(
        operator: BilaplacianOperator,
        elimination: Elimination,
        refactorisation: Refactorisation,
        budget: Budget,
        cancel: &Cancel,
    ) -> Result<Self, SystemError> {
        let (numbering, solution) = direct(&operator, elimination, refactorisation, budget, cancel)?;
        Ok(Self::joined(operator, numbering, solution))
    }

    /// Like [`BilaplacianSystem::new`], but solves with the Laplacian's factor if A's does not fit the budget and the
    /// operator allows that.
    pub fn planned(
        mut operator: BilaplacianOperator,
        plan: &EliminationPlan,
        refactorisation: Refactorisation,
        budget: Budget,
        cancel: &Cancel,
    ) -> Result<Self, SystemError> {
        if let Some(elimination) = plan.direct(operator.power, budget) {
            match direct(&operator, elimination, refactorisation, budget, cancel) {
                Ok((numbering, solution)) => return Ok(Self::joined(operator, numbering, solution)),
                Err(refused) if !refused.is_for_memory() || !Capacitance::applies_to(&operator) => return Err(refused),
                Err(_) => {}
            }
        } else if !Capacitance::applies_to(&operator) {
            return Err(SystemError::Budget(Limit::Bytes(budget.bytes)));
        }
        let elimination = plan.of_laplacian(budget, cancel)?;
        let (numbering, solution) = by_laplacian(&mut operator, elimination, refactorisation, budget, cancel)?;
        Ok(Self::joined(operator, numbering, solution))
    }

    fn joined(operator: BilaplacianOperator, (columns, column_of): Numbering, solution: Solution) -> Self {
        let springs = operator.springs.locals().iter();
        Self {
            held_reach: HeldReach::of(&operator, &columns, &column_of),
            spring_columns: springs.map(|&local| column_of[local as usize]).collect(),
            operator,
            columns,
            column_of,
            solution,
            contraction: 0.0,
        }
    }

    /// The column of each local vertex, [`CONSTRAINED`] if it is not solved.
    pub fn column_of(&self) -> &[u32] {
        &self.column_of
    }

    /// The solved local vertices.
    pub fn columns(&self) -> &[u32] {
        &self.columns
    }

    /// The number of entries that the factor stores.
    pub fn factor_len(&self) -> usize {
        self.solution.stored()
    }

    /// The data that the binding of a nearly equal system can reuse.
    pub fn factored(&self) -> &Arc<RenewableFactor> {
        self.solution.factored()
    }

    /// The solver with A.
    pub fn solution(&self) -> &Solution {
        &self.solution
    }

    /// From now on solves may run in any order: see [`Solution::is_learning`].
    pub fn settle(&mut self) {
        self.solution.settle();
    }

    /// S: the scale of each column.
    pub fn scale(&self) -> &[f64] {
        self.solution.factored().scale()
    }

    /// S (W (c − d) − A d) on the solved vertices, by differences along edges and springs.
    pub fn scaled_residual<const K: usize>(&self, d: &[[f64; K]]) -> Vec<[f64; K]> {
        let potential = self.operator.potential(d);
        let residual = self
            .columns
            .par_iter()
            .with_min_len(CHUNK)
            .zip(self.scale())
            .map(|(&local, &scale)| {
                self.operator
                    .force(local as usize, &potential)
                    .map(|value| -value * scale)
            })
            .collect();
        self.with_pulls(residual, d)
    }

    /// Like [`BilaplacianSystem::scaled_residual`], for a field that is zero on the solved vertices.
    pub fn scaled_residual_from_zero<const K: usize>(&self, d: &[[f64; K]]) -> Vec<[f64; K]> {
        let Some(reach) = &self.held_reach else {
            return self.scaled_residual(d);
        };
        self.with_pulls(reach.scaled_force(&self.operator, (&self.columns, self.scale()), d), d)
    }

    fn with_pulls<const K: usize>(&self, mut residual: Vec<[f64; K]>, d: &[[f64; K]]) -> Vec<[f64; K]> {
        for (spring, &column) in self.spring_columns.iter().enumerate() {
            let pull = self.operator.pull(spring, d);
            for k in 0..K {
                residual[column as usize][k] += self.scale()[column as usize] * pull[k];
            }
        }
        residual
    }
}

/// The local vertex of each column, and the column of each local vertex.
type Numbering = (Vec<u32>, Vec<u32>);

fn numbered(operator: &BilaplacianOperator, elimination: &Elimination) -> Numbering {
    let columns = operator.laplacian.locals(&elimination.order);
    let mut column_of = vec![CONSTRAINED; operator.laplacian.vertices().len()];
    for (column, &local) in columns.iter().enumerate() {
        column_of[local as usize] = column as u32;
    }
    (columns, column_of)
}

/// The factor of A, and the correction for its hubs.
fn direct(
    operator: &BilaplacianOperator,
    mut elimination: Elimination,
    refactorisation: Refactorisation,
    budget: Budget,
    cancel: &Cancel,
) -> Result<(Numbering, Solution), SystemError> {
    let laplacian = &operator.laplacian;
    let (mut columns, mut column_of) = numbered(operator, &elimination);
    let hubs = Hubs::of(operator, &column_of);
    if !hubs.is_empty() {
        // The ordering has the surface's own hubs last; the hubs of an intrinsic triangulation are moved to the end
        // here.
        elimination =
            elimination.with_last(|vertex| laplacian.local(vertex).is_some_and(|local| hubs.contains(local as u32)));
        (columns, column_of) = numbered(operator, &elimination);
    }
    let rank = hubs.rank(operator);
    let of_hubs = bytes_of(LowRank::stored_at_rank(columns.len(), rank), size_of::<f64>());
    let budget = budget.without(of_hubs).map_err(SystemError::Budget)?;
    let refuse = |error| refused(error, operator, &columns);
    let matrix = assemble_bilaplacian(operator, &columns, &column_of, &hubs, budget).map_err(refuse)?;
    cancel.check().map_err(|_| SystemError::Cancelled)?;
    let factored =
        RenewableFactor::of(matrix, elimination, &SHIFTS, refactorisation, budget, cancel).map_err(refuse)?;
    let mut low_rank = None;
    if !hubs.is_empty() {
        let (vectors, c) = hubs.correction(operator, &column_of, factored.scale());
        low_rank = Some(LowRank::of(&factored.factor, vectors, &c).map_err(refuse)?);
    }
    Ok(((columns, column_of), Solution::Factor(Arc::new(factored), low_rank)))
}

/// The factor of the Laplacian, and the data that make it solve with A. The operator is unchanged afterwards.
fn by_laplacian(
    operator: &mut BilaplacianOperator,
    elimination: Elimination,
    refactorisation: Refactorisation,
    budget: Budget,
    cancel: &Cancel,
) -> Result<(Numbering, Solution), SystemError> {
    let (columns, column_of) = numbered(operator, &elimination);
    // The vectors of a solve, besides those of every solve.
    let of_vectors = bytes_of(columns.len(), 3 * size_of::<[f64; 5]>());
    let budget = budget.without(of_vectors).map_err(SystemError::Budget)?;
    let membrane = BilaplacianOperator::membrane(std::mem::take(&mut operator.laplacian));
    let matrix = assemble_bilaplacian(&membrane, &columns, &column_of, &Hubs::default(), budget);
    operator.laplacian = membrane.laplacian;
    let refuse = |error| refused(error, operator, &columns);
    let matrix = matrix.map_err(refuse)?;
    cancel.check().map_err(|_| SystemError::Cancelled)?;
    let factored =
        RenewableFactor::of(matrix, elimination, &SHIFTS, refactorisation, budget, cancel).map_err(refuse)?;
    let taken = bytes_of(factored.factor.stored(), size_of::<f64>());
    let left = budget.without(taken).map_err(SystemError::Budget)?;
    let capacitance = Capacitance::new(operator, (&columns, &column_of), factored, left, cancel);
    Ok(((columns, column_of), Solution::Capacitance(Box::new(capacitance))))
}

/// A factorisation's refusal, whose columns are the local vertices `columns`.
fn refused(error: FactorError, operator: &BilaplacianOperator, columns: &[u32]) -> SystemError {
    SystemError::of(error, |column| {
        let local = columns.get(column).map_or(0, |&local| local as usize);
        operator.laplacian.vertices()[local]
    })
}
