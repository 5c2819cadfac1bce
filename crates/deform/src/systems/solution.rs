//! The bound solver for A: its own factor, or the Laplacian's if that does not fit.

use std::sync::Arc;

use pliant_mesh::Cancel;

use crate::sparse::low_rank::LowRank;
use crate::sparse::refactorisation::RenewableFactor;
use crate::systems::capacitance::Capacitance;

/// Solves S A S x = r, S being the scale of the columns.
#[derive(Debug)]
pub(crate) enum Solution {
    /// The factor of A and the low-rank correction for hubs, if there are any.
    Factor(Arc<RenewableFactor>, Option<LowRank>),
    /// The factor of the Laplacian.
    Capacitance(Box<Capacitance>),
}

impl Solution {
    /// The factor of either matrix.
    pub fn factored(&self) -> &Arc<RenewableFactor> {
        match self {
            Self::Factor(factored, _) => factored,
            Self::Capacitance(capacitance) => capacitance.factored(),
        }
    }

    /// x ← (S A S)⁻¹ x, up to the error of the factor, or leaving the share `left` of an iterative solution.
    pub fn solve<const K: usize>(&self, x: &mut [[f64; K]], left: f64, cancel: &Cancel) {
        match self {
            Self::Factor(factored, low_rank) => {
                factored.factor.solve(x);
                if let Some(low_rank) = low_rank {
                    low_rank.correct(x);
                }
            }
            Self::Capacitance(capacitance) => capacitance.solve(x, left, cancel),
        }
    }

    /// The number of stored entries.
    pub fn stored(&self) -> usize {
        match self {
            Self::Factor(factored, low_rank) => factored.factor.stored() + low_rank.as_ref().map_or(0, LowRank::stored),
            Self::Capacitance(capacitance) => capacitance.stored(),
        }
    }

    /// Returns true if solutions are found by iteration.
    pub fn is_iterative(&self) -> bool {
        matches!(self, Self::Capacitance(_))
    }

    /// Returns true if solves must follow each other in a fixed order.
    pub fn is_learning(&self) -> bool {
        match self {
            Self::Factor(..) => false,
            Self::Capacitance(capacitance) => capacitance.is_learning(),
        }
    }

    /// From now on solves may run in any order.
    pub fn settle(&mut self) {
        if let Self::Capacitance(capacitance) = self {
            capacitance.settle();
        }
    }

    /// Sentences about an unusual way of solving.
    pub fn warnings(&self) -> Vec<String> {
        let stiffened = |shift: f64| {
            format!(
                "the system was barely stable on this mesh, so it was stiffened by {shift:.0e} of its diagonal and \
                 refined"
            )
        };
        let mut sentences = Vec::new();
        if let Self::Capacitance(capacitance) = self {
            sentences.push(capacitance.sentence());
        }
        let shift = self.factored().shift;
        sentences.extend((shift > 0.0).then(|| stiffened(shift)));
        sentences
    }
}
