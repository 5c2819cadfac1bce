//! The supernodal sparse Cholesky factor L Lᵀ of a matrix that is already permuted [Dav06].
//!
//! The ordering brings its supernodes (`ordering`). `symbolic` finds their rows, `numeric` factors over the parts that
//! `symbolic::assembly_tree` cuts, and `solve` substitutes over the same parts.
//!
//! A simplicial factorisation of the same systems took 720 and 12,300 ms at 45,797 and 183,208 free vertices where a
//! supernodal one took 114 and 840 (horse.ply and once subdivided, one core).

use pliant_mesh::Cancel;

use crate::budget::Budget;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::ScaledMatrix;
use crate::sparse::numeric::Numbers;
use crate::sparse::solve::PartRows;
use crate::sparse::solve::rhs::Real;
use crate::sparse::solve::substitution::Substitution;
use crate::sparse::symbolic::Symbolic;
use crate::sparse::symbolic::assembly_tree::AssemblyTree;
use crate::sparse::{numeric, solve};

/// A factor of the scaled matrix.
#[derive(Debug)]
pub(crate) struct Factor {
    pub(super) symbolic: Symbolic,
    pub(super) assembly_tree: AssemblyTree,
    /// One for each part; none before the factor is filled.
    pub(super) numbers: Vec<Numbers>,
}

/// Shifts of the unit diagonal that are tried one after the other for a preconditioner.
const SHIFTS: [f64; 6] = [0.0, 1e-13, 1e-11, 1e-9, 1e-7, 1e-5];

impl Factor {
    /// Factors the matrix, whose supernodes end at `ends`, with `shift` added to its unit diagonal.
    #[cfg(test)]
    pub fn of(matrix: &ScaledMatrix, ends: &[u32], shift: f64, cancel: &Cancel) -> Result<Self, FactorError> {
        let mut factor = Self::analysed(matrix, ends, Budget::default())?;
        factor.fill(matrix, shift, cancel)?;
        Ok(factor)
    }

    /// Like [`Factor::of`], for a preconditioner: the unit diagonal is raised until the matrix can be factored. That
    /// makes steps shorter; the minimum stays the same. The refusal is that of the unshifted matrix.
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

    /// The symbolic factorisation: everything but the numbers.
    ///
    /// # Errors
    /// The factorisation exceeds the budget.
    pub fn analysed(matrix: &ScaledMatrix, ends: &[u32], budget: Budget) -> Result<Self, FactorError> {
        let symbolic = Symbolic::of(matrix, ends, budget)?;
        let assembly_tree = AssemblyTree::of(&symbolic);
        Ok(Self {
            symbolic,
            assembly_tree,
            numbers: Vec::new(),
        })
    }

    /// Computes the factor that [`Factor::analysed`] left empty.
    pub fn fill(&mut self, matrix: &ScaledMatrix, shift: f64, cancel: &Cancel) -> Result<(), FactorError> {
        let (symbolic, assembly_tree) = (&self.symbolic, &self.assembly_tree);
        self.numbers = numeric::factor(matrix, shift, symbolic, assembly_tree, &[], &[], cancel)?;
        Ok(())
    }

    /// A copy of its values, laid out for many solves.
    ///
    /// # Errors
    /// [`FactorError::Memory`].
    pub fn substitution<T: Real>(&self) -> Result<Substitution<T>, FactorError> {
        Substitution::new(&self.symbolic, &self.assembly_tree, &self.numbers)
    }

    /// The number of stored entries.
    pub fn stored(&self) -> usize {
        self.symbolic.stored()
    }

    /// The number of columns.
    pub fn column_count(&self) -> usize {
        self.symbolic.column_count()
    }

    /// Multiplications and additions of a factorisation.
    pub fn work(&self) -> f64 {
        (0..self.symbolic.supernode_count())
            .map(|s| self.symbolic.work(s))
            .sum()
    }

    /// The shifts, from the first on, whose factorisations together stay within the budget; always at least one.
    pub(super) fn affordable<'a>(&self, shifts: &'a [f64], budget: Budget) -> &'a [f64] {
        let affordable = (budget.operations_for(self.column_count()) / self.work().max(1.0)) as usize;
        &shifts[..affordable.clamp(1, shifts.len())]
    }

    #[cfg(test)]
    pub fn parts(&self) -> (&Symbolic, &AssemblyTree) {
        (&self.symbolic, &self.assembly_tree)
    }

    /// Solves for K right-hand sides in place.
    pub fn solve<const K: usize>(&self, x: &mut [[f64; K]]) {
        self.solve_within(None, x, &mut Vec::new());
    }

    /// Like [`Factor::solve`], in memory that is kept from solve to solve. If only some parts are wanted, from
    /// [`Factor::parts_above`], `x` is undefined in the columns of the others.
    pub fn solve_within<const K: usize>(
        &self,
        parts: Option<&[bool]>,
        x: &mut [[f64; K]],
        part_rows: &mut PartRows<K>,
    ) {
        let is_wanted = |part: usize| parts.is_none_or(|parts| parts[part]);
        let (symbolic, assembly_tree) = (&self.symbolic, &self.assembly_tree);
        solve::solve_in_place(symbolic, assembly_tree, &self.numbers, x, part_rows, is_wanted);
    }

    /// For each part whether the solution in one of these columns depends on it: those of the columns, and all above.
    pub fn parts_above(&self, columns: impl IntoIterator<Item = u32>) -> Vec<bool> {
        let parts = &self.assembly_tree.parts;
        let mut are_above = vec![false; parts.len()];
        for column in columns {
            let mut next = Some(parts.partition_point(|part| part.columns.end <= column as usize));
            while let Some(part) = next.filter(|&part| !are_above[part]) {
                are_above[part] = true;
                next = parts[part].parent;
            }
        }
        are_above
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
pub(crate) mod tests {
    use super::Factor;
    use crate::sparse::Elimination;
    use crate::sparse::matrix::{CONSTRAINED, ScaledMatrix};
    use crate::systems::assembly::assemble_bilaplacian;
    use crate::systems::hubs::Hubs;
    use crate::systems::operator::BilaplacianOperator;
    use crate::systems::plate_energy::PlateEnergy;
    use crate::{Budget, Laplacian, Ordering};
    use pliant_mesh::{Cancel, Drawn, Progress, shapes};

    /// The factor with every ninth vertex constrained, in the order that binding uses.
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
        let operator = BilaplacianOperator::new(laplacian, PlateEnergy::of_power(2), 1.0);
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
}
