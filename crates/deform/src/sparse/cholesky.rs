//! The supernodal sparse Cholesky factor L Lᵀ, in the order that the matrix already has [Dav06].
//!
//! The ordering brings its supernodes (`ordering`). `symbolic` finds their rows, `numeric` factors over the parts that
//! `symbolic::assembly_tree` cuts, and `solve` substitutes over the same parts.
//!
//! A simplicial factorisation of the same systems took 720 and 12,300 ms at 45,797 and 183,208 free vertices where a
//! supernodal one took 114 and 840 (horse.ply and once subdivided, one core).

use std::collections::BTreeSet;
use std::sync::Arc;

use pliant_mesh::Cancel;

use crate::budget::Budget;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::ScaledMatrix;
use crate::sparse::numeric::Numbers;
use crate::sparse::numeric::reuse::{Named, equal_parts, worth_keeping};
use crate::sparse::ordering::elimination::Elimination;
use crate::sparse::solve::substitution::{Real, Substitution};
use crate::sparse::symbolic::Symbolic;
use crate::sparse::symbolic::assembly_tree::AssemblyTree;
use crate::sparse::{numeric, solve};

/// A factor of the scaled matrix.
#[derive(Debug)]
pub(crate) struct Factor {
    symbolic: Symbolic,
    assembly_tree: AssemblyTree,
    /// One a part; none before the factor is filled.
    numbers: Vec<Numbers>,
}

/// What of a factor is for the next one, of nearly the same matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Refactorisation<'a> {
    /// Nothing: there will be none. Half the memory.
    Never,
    /// What parts left is kept, as far as it is [worth it](worth_keeping); what the former factor, if there is one, has
    /// to the bit is taken from there.
    From(Option<&'a RenewableFactor>),
}

/// A factor that remembers what it was made from, so that one of nearly the same matrix can take over what is equal.
#[derive(Debug)]
pub(crate) struct RenewableFactor {
    pub factor: Factor,
    matrix: ScaledMatrix,
    elimination: Elimination,
    /// What was added to the matrix' unit diagonal.
    pub shift: f64,
}

/// What is added to the unit diagonal, one after the other, of a matrix that is descended by.
const SHIFTS: [f64; 6] = [0.0, 1e-13, 1e-11, 1e-9, 1e-7, 1e-5];

impl Factor {
    /// Factors the matrix, whose columns stand in supernodes that end at `ends`, with `shift` added to its unit diagonal.
    #[cfg(test)]
    pub fn of(matrix: &ScaledMatrix, ends: &[u32], shift: f64, cancel: &Cancel) -> Result<Self, FactorError> {
        let mut factor = Self::analysed(matrix, ends, Budget::default())?;
        factor.fill(matrix, shift, cancel)?;
        Ok(factor)
    }

    /// As [`Factor::of`] for a method that only descends by it: something is added to the unit diagonal until that can
    /// be factored. Steps get shorter by it; results stay the same. The refusal is that of the matrix as it is.
    pub fn to_descend_by(
        matrix: &ScaledMatrix,
        ends: &[u32],
        budget: Budget,
        cancel: &Cancel,
    ) -> Result<Self, FactorError> {
        let mut refused = None;
        let mut factor = Self::analysed(matrix, ends, budget)?;
        for shift in factor.affordable(&SHIFTS, budget) {
            if cancel.is_cancelled() {
                return Err(FactorError::Cancelled);
            }
            match factor.fill(matrix, *shift, cancel) {
                Err(error @ FactorError::Pivot(_)) => refused = refused.or(Some(error)),
                other => return other.map(|()| factor),
            }
        }
        Err(refused.unwrap_or(FactorError::Memory))
    }

    /// What the factor is to hold, without numbers.
    ///
    /// # Errors
    /// Where its factorisation takes more than the budget.
    pub fn analysed(matrix: &ScaledMatrix, ends: &[u32], budget: Budget) -> Result<Self, FactorError> {
        let symbolic = Symbolic::of(matrix, ends, budget)?;
        let assembly_tree = AssemblyTree::of(&symbolic);
        Ok(Self {
            symbolic,
            assembly_tree,
            numbers: Vec::new(),
        })
    }

    /// Factors into what [`Factor::analysed`] left empty.
    pub fn fill(&mut self, matrix: &ScaledMatrix, shift: f64, cancel: &Cancel) -> Result<(), FactorError> {
        let (symbolic, assembly_tree) = (&self.symbolic, &self.assembly_tree);
        self.numbers = numeric::factor(matrix, shift, symbolic, assembly_tree, &[], &[], cancel)?;
        Ok(())
    }

    /// Its values laid out for solving again and again.
    ///
    /// # Errors
    /// [`FactorError::Memory`].
    pub fn substitution<T: Real>(&self) -> Result<Substitution<T>, FactorError> {
        Substitution::new(&self.symbolic, &self.assembly_tree, &self.numbers)
    }

    /// How many numbers the factor stores.
    pub fn stored(&self) -> usize {
        self.symbolic.stored()
    }

    /// How many columns it has.
    pub fn column_count(&self) -> usize {
        self.symbolic.column_count()
    }

    /// Multiplications and additions of a factorisation.
    pub fn work(&self) -> f64 {
        (0..self.symbolic.supernode_count())
            .map(|s| self.symbolic.work(s))
            .sum()
    }

    /// Those of the shifts, from the first on, whose factorisations together stay within the budget; never none.
    fn affordable<'a>(&self, shifts: &'a [f64], budget: Budget) -> &'a [f64] {
        let affordable = (budget.operations_for(self.column_count()) / self.work().max(1.0)) as usize;
        &shifts[..affordable.clamp(1, shifts.len())]
    }

    #[cfg(test)]
    pub fn parts(&self) -> (&Symbolic, &AssemblyTree) {
        (&self.symbolic, &self.assembly_tree)
    }

    /// Solves for K right-hand sides in place.
    pub fn solve<const K: usize>(&self, x: &mut [[f64; K]]) {
        solve::solve_in_place(&self.symbolic, &self.assembly_tree, &self.numbers, x);
    }
}

impl RenewableFactor {
    /// Factors the matrix whose columns are those of `elimination`, with the first of `shifts` with which that goes.
    /// The refusal is that of the first.
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

    /// The numbers of the parts that another matrix has to the bit.
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

    /// The share of the numbers that are `other`'s.
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

    /// How many numbers are kept beside the factor for the next one.
    #[cfg(test)]
    pub fn kept(&self) -> usize {
        self.factor.numbers.iter().map(Numbers::kept).sum()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
pub(crate) mod tests {
    use super::{Factor, Refactorisation, RenewableFactor};
    use crate::Bilaplacian;
    use crate::Budget;
    use crate::Laplacian;
    use crate::Ordering;
    use crate::bilaplacian::assembly::assemble_bilaplacian;
    use crate::bilaplacian::hubs::Hubs;
    use crate::bilaplacian::operator::BilaplacianOperator;
    use crate::sparse::Elimination;
    use crate::sparse::matrix::{CONSTRAINED, ScaledMatrix};
    use pliant_mesh::{Cancel, Drawn, Progress, shapes};

    /// The matrix's factor with every ninth vertex held, in the order that binding takes.
    pub(crate) fn factor_of(drawn: Drawn) -> Factor {
        let (matrix, ends) = bilaplacian_of(drawn);
        Factor::of(&matrix, &ends, 0.0, &Cancel::new()).unwrap()
    }

    fn matrix() -> (ScaledMatrix, Vec<u32>) {
        bilaplacian_of(shapes::torus(14, 9))
    }

    fn bilaplacian_of(drawn: Drawn) -> (ScaledMatrix, Vec<u32>) {
        let model = shapes::model(drawn);
        let count = model.surface.positions.len();
        let laplacian = Laplacian::of(&model.surface, &model.topology, &vec![1.0; count]);
        let ordering = Ordering::of(&model.topology, 2, &Progress::new(), &Cancel::new()).unwrap();
        let solved: Vec<u32> = (0..count as u32).filter(|v| v % 9 != 0).collect();
        let Elimination { order: columns, ends } = ordering.elimination(&solved);
        let mut column_of = vec![CONSTRAINED; count];
        for (column, &vertex) in columns.iter().enumerate() {
            column_of[vertex as usize] = column as u32;
        }
        let operator = BilaplacianOperator::new(laplacian, &Bilaplacian::default(), 1.0);
        let matrix = assemble_bilaplacian(&operator, &columns, &column_of, &Hubs::default(), Budget::default());
        (matrix.unwrap(), ends)
    }

    fn product<const K: usize>(matrix: &ScaledMatrix, x: &[[f64; K]]) -> Vec<[f64; K]> {
        let mut y = vec![[0.0; K]; x.len()];
        for column in 0..x.len() {
            for entry in matrix.lower_offsets[column] as usize..matrix.lower_offsets[column + 1] as usize {
                let (row, value) = (matrix.lower_rows[entry] as usize, matrix.lower_values[entry]);
                for k in 0..K {
                    y[row][k] += value * x[column][k];
                    if row != column {
                        y[column][k] += value * x[row][k];
                    }
                }
            }
        }
        y
    }

    fn solving_undoes_multiplying<const K: usize>() {
        let (matrix, ends) = matrix();
        let factor = Factor::of(&matrix, &ends, 0.0, &Cancel::new()).unwrap();
        let x: Vec<[f64; K]> = (0..matrix.scale.len())
            .map(|i| std::array::from_fn(|k| ((i * 7 + k * 3) % 11) as f64 - 5.0))
            .collect();
        let mut y = product(&matrix, &x);
        factor.solve(&mut y);
        for (x, y) in x.iter().zip(&y) {
            for k in 0..K {
                assert!((x[k] - y[k]).abs() < 1e-7, "{K}: {} {}", x[k], y[k]);
            }
        }
    }

    #[test]
    fn solving_undoes_multiplying_for_any_number_of_right_hand_sides() {
        solving_undoes_multiplying::<1>();
        solving_undoes_multiplying::<3>();
        solving_undoes_multiplying::<4>();
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_is_refused_with_its_column() {
        let (mut matrix, ends) = matrix();
        let diagonal = matrix.lower_offsets[5] as usize;
        matrix.lower_values[diagonal] = -1.0;
        let refused = Factor::of(&matrix, &ends, 0.0, &Cancel::new()).err();
        assert!(
            matches!(refused, Some(super::FactorError::Pivot(column)) if column >= 5),
            "{refused:?}"
        );
    }

    #[test]
    fn a_raised_flag_ends_a_factorisation() {
        let cancel = Cancel::new();
        cancel.cancel();
        assert_eq!(
            Factor::of(&matrix().0, &matrix().1, 0.0, &cancel).err(),
            Some(super::FactorError::Cancelled)
        );
    }

    #[test]
    fn the_bits_of_factor_and_solution_do_not_depend_on_the_number_of_threads() {
        // Large enough for tasks, and for supernodes of more strips than one dense step takes.
        let (matrix, ends) = bilaplacian_of(shapes::icosphere(5));
        let outcome = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let factor = Factor::of(&matrix, &ends, 0.0, &Cancel::new()).unwrap();
                let mut x: Vec<[f64; 3]> = (0..matrix.scale.len()).map(|i| [1.0, i as f64, -0.3]).collect();
                factor.solve(&mut x);
                let lines = factor.numbers.iter().flat_map(|numbers| numbers.panels.iter());
                (lines.flat_map(|line| line.0).collect::<Vec<f64>>(), x)
            })
        };
        let (values, x) = outcome(1);
        for threads in [2, 5] {
            let (other_values, other_x) = outcome(threads);
            assert!(
                values
                    .iter()
                    .zip(&other_values)
                    .all(|(a, b)| a.to_bits() == b.to_bits())
            );
            let bits = |row: &[f64; 3]| row.map(f64::to_bits);
            assert!(x.iter().map(bits).eq(other_x.iter().map(bits)), "{threads}");
        }
    }

    /// Columns in an order that fits the matrix badly, so that parts leave much more than they have.
    fn badly_ordered() -> (ScaledMatrix, Elimination) {
        let model = shapes::model(shapes::grid(60, 60));
        let count = model.surface.positions.len();
        let laplacian = Laplacian::of(&model.surface, &model.topology, &vec![1.0; count]);
        // Every other vertex first, one by one: hardly any of them neighbour each other.
        let order: Vec<u32> = (0..count as u32)
            .step_by(3)
            .chain((0..count as u32).filter(|v| v % 3 != 0))
            .collect();
        let mut column_of = vec![CONSTRAINED; count];
        for (column, &vertex) in order.iter().enumerate() {
            column_of[vertex as usize] = column as u32;
        }
        let operator = BilaplacianOperator::new(laplacian, &Bilaplacian::default(), 1.0);
        let mut matrix =
            assemble_bilaplacian(&operator, &order, &column_of, &Hubs::default(), Budget::default()).unwrap();
        // Nothing is held: let every vertex be held a little.
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
        // Nothing changed: all is taken over, whatever was kept of it.
        assert_eq!(bind(Refactorisation::From(Some(&first))).share_of(&first), 1.0);
        assert_eq!(bind(Refactorisation::Never).kept(), 0);
    }
}
