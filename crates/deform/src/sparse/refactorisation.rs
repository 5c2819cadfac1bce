//! Partial refactorisation [HA18]: the factor of a nearly equal matrix reuses the parts that are the same.

use std::collections::BTreeSet;
use std::sync::Arc;

use pliant_mesh::Cancel;

use crate::budget::Budget;
use crate::sparse::cholesky::Factor;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::ScaledMatrix;
use crate::sparse::numeric;
use crate::sparse::numeric::Numbers;
use crate::sparse::numeric::reuse::{Named, equal_parts, worth_keeping};
use crate::sparse::ordering::elimination::Elimination;

/// The data that a factorisation keeps for the next one, and those that it reuses.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Refactorisation<'a> {
    /// Nothing is kept or reused. That needs half the memory.
    Never,
    /// Contribution matrices are kept if that is [worth it](worth_keeping), and parts that are equal to the bit in the
    /// previous factor, if there is one, are reused.
    From(Option<&'a RenewableFactor>),
}

/// A factor with its matrix, so that the factor of a nearly equal one can reuse equal parts.
#[derive(Debug)]
pub(crate) struct RenewableFactor {
    pub factor: Factor,
    matrix: ScaledMatrix,
    elimination: Elimination,
    /// The shift of the matrix' unit diagonal.
    pub shift: f64,
}

impl RenewableFactor {
    /// Factors the matrix, whose columns are those of `elimination`, with the first of `shifts` that works. The refusal
    /// is that of the first shift.
    pub fn of(
        matrix: ScaledMatrix,
        elimination: Elimination,
        shifts: &[f64],
        refactorisation: Refactorisation,
        budget: Budget,
        cancel: &Cancel,
    ) -> Result<Self, FactorError> {
        let mut factor = Factor::analysed(&matrix, &elimination.ends, budget)?;
        let new = Named {
            matrix: &matrix,
            elimination: &elimination,
            symbolic: &factor.symbolic,
            assembly_tree: &factor.assembly_tree,
        };
        let mut refused = None;
        let kept = match refactorisation {
            Refactorisation::Never => Vec::new(),
            Refactorisation::From(_) => worth_keeping(&factor.symbolic, &factor.assembly_tree),
        };
        for &shift in factor.affordable(shifts, budget) {
            let known = match refactorisation {
                Refactorisation::From(Some(former)) if former.shift.to_bits() == shift.to_bits() => {
                    former.known_to(new)
                }
                Refactorisation::Never | Refactorisation::From(_) => Vec::new(),
            };
            let (symbolic, assembly_tree) = (&factor.symbolic, &factor.assembly_tree);
            match numeric::factor(&matrix, shift, symbolic, assembly_tree, &known, &kept, cancel) {
                Ok(numbers) => {
                    factor.numbers = numbers;
                    return Ok(Self {
                        factor,
                        matrix,
                        elimination,
                        shift,
                    });
                }
                Err(error @ FactorError::Pivot(_)) => refused = refused.or(Some(error)),
                Err(other) => return Err(other),
            }
        }
        Err(refused.unwrap_or(FactorError::Memory))
    }

    /// The numbers of the parts that are equal to the bit.
    fn known_to(&self, new: Named) -> Vec<Option<Numbers>> {
        let old = Named {
            matrix: &self.matrix,
            elimination: &self.elimination,
            symbolic: &self.factor.symbolic,
            assembly_tree: &self.factor.assembly_tree,
        };
        let equal = equal_parts(new, old);
        equal
            .into_iter()
            .map(|part| Some(self.factor.numbers[part?].clone()))
            .collect()
    }

    /// The share of the numbers that were reused from `other`.
    pub fn share_of(&self, other: &Self) -> f64 {
        let theirs: BTreeSet<_> = other
            .factor
            .numbers
            .iter()
            .map(|numbers| Arc::as_ptr(&numbers.panels))
            .collect();
        let is_shared = |numbers: &&Numbers| theirs.contains(&Arc::as_ptr(&numbers.panels));
        let lines = |numbers: &Numbers| numbers.panels.len();
        let shared: usize = self.factor.numbers.iter().filter(is_shared).map(lines).sum();
        let all: usize = self.factor.numbers.iter().map(lines).sum();
        shared as f64 / all.max(1) as f64
    }

    /// S: the scale of each column.
    pub fn scale(&self) -> &[f64] {
        &self.matrix.scale
    }

    /// The number of entries kept beside the factor for the next one.
    #[cfg(test)]
    pub fn kept(&self) -> usize {
        self.factor.numbers.iter().map(Numbers::kept).sum()
    }
}

/// The factor of a bound linear method. [`crate::Problem::rebind`] reuses the parts of it that are unchanged. Cheap to clone.
#[derive(Clone, Debug)]
pub struct ReusableFactor(pub(crate) Arc<RenewableFactor>);

impl ReusableFactor {
    pub(crate) fn factored(&self) -> &RenewableFactor {
        &self.0
    }

    /// The share of the factor's numbers that were reused from `other`, 0 to 1.
    pub fn share_of(&self, other: &Self) -> f64 {
        self.0.share_of(&other.0)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::{Refactorisation, RenewableFactor};
    use crate::sparse::Elimination;
    use crate::sparse::cholesky::Factor;
    use crate::sparse::matrix::{CONSTRAINED, ScaledMatrix};
    use crate::systems::assembly::assemble_bilaplacian;
    use crate::systems::hubs::Hubs;
    use crate::systems::operator::BilaplacianOperator;
    use crate::systems::plate_energy::PlateEnergy;
    use crate::{Budget, Laplacian};
    use pliant_mesh::{Cancel, shapes};

    /// A matrix in a bad order, so that contributions are much larger than the parts themselves.
    fn badly_ordered() -> (ScaledMatrix, Elimination) {
        let model = shapes::model(shapes::grid(60, 60));
        let count = model.surface.positions.len();
        let laplacian = Laplacian::of(&model.surface, &model.topology, &vec![1.0; count]);
        // Every other vertex comes first, one by one: hardly any of them neighbour each other.
        let order: Vec<u32> = (0..count as u32)
            .step_by(3)
            .chain((0..count as u32).filter(|v| v % 3 != 0))
            .collect();
        let mut column_of = vec![CONSTRAINED; count];
        for (column, &vertex) in order.iter().enumerate() {
            column_of[vertex as usize] = column as u32;
        }
        let operator = BilaplacianOperator::new(laplacian, PlateEnergy::of_power(2), 1.0);
        let mut matrix =
            assemble_bilaplacian(&operator, &order, &column_of, &Hubs::default(), Budget::default()).unwrap();
        // No vertex is constrained, so the matrix is singular: shift its diagonal.
        for column in 0..count {
            matrix.lower_values[matrix.lower_offsets[column] as usize] += 0.1;
        }
        let ends = (1..=count as u32)
            .filter(|end| end % 8 == 0 || *end == count as u32)
            .collect();
        (matrix, Elimination { order, ends })
    }

    #[test]
    fn what_is_kept_for_the_next_factor_is_no_more_than_the_factor_and_is_worth_it() {
        let (matrix, elimination) = badly_ordered();
        let cancel = Cancel::new();
        let bind = |refactorisation| {
            let (matrix, elimination) = badly_ordered();
            RenewableFactor::of(matrix, elimination, &[0.0], refactorisation, Budget::default(), &cancel).unwrap()
        };
        let all = {
            let factor = Factor::analysed(&matrix, &elimination.ends, Budget::default()).unwrap();
            let lines = |part: &crate::sparse::symbolic::assembly_tree::Part| {
                crate::sparse::symbolic::contribution_lines(factor.symbolic.pattern(part.supernodes.end - 1).len())
            };
            8 * factor.assembly_tree.parts.iter().map(lines).sum::<usize>()
        };
        let first = bind(Refactorisation::From(None));
        assert!(all > 2 * first.factor.stored(), "all of it is {all}");
        assert!(first.kept() <= first.factor.stored());
        assert!(2 * first.kept() > first.factor.stored());
        // Nothing changed: everything is reused, even if nothing was kept.
        assert_eq!(bind(Refactorisation::From(Some(&first))).share_of(&first), 1.0);
        assert_eq!(bind(Refactorisation::Never).kept(), 0);
    }
}
