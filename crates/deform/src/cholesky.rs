//! The sparse Cholesky factor: faer's supernodal L Lᵀ in the order that the matrix already has.
//!
//! Symbolic and numeric parts are two steps, since the pattern outlives the values. Sequential inside (`Par::Seq`).
//!
//! Measured on horse.ply and once subdivided (45,797 and 183,208 free vertices, one core of a busy machine, processor
//! time): factoring took 114 and 840 ms supernodal, 720 and 12,300 ms simplicial; solving for three right-hand sides 18
//! and 98 ms supernodal, 12 and 74 ms simplicial. A frame solves nothing, so the factorisation decides. Other
//! relaxations of the supernodes than faer's changed fill (6.4 to 6.8 million numbers) and times by under a tenth.

use faer::Par;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::sparse::linalg::SymbolicSupernodalParams;
use faer::sparse::linalg::cholesky::{simplicial, supernodal};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};

use crate::assembly::PlateMatrix;
use crate::triangular;

/// A factor of the scaled matrix.
#[derive(Debug)]
pub(crate) struct Factor {
    symbolic: supernodal::SymbolicSupernodalCholesky<u32>,
    values: Vec<f64>,
}

/// Why there is no factor.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum FactorError {
    /// The pivot of this column is not above zero.
    Pivot(usize),
    /// Too large for the machine or for the index type.
    Memory,
}

impl Factor {
    /// Factors the matrix with `shift` added to its unit diagonal.
    pub fn of(plate: &PlateMatrix, shift: f64) -> Result<Self, FactorError> {
        let symbolic = analyse(plate).ok_or(FactorError::Memory)?;
        let mut values = Vec::new();
        values
            .try_reserve_exact(symbolic.len_val())
            .map_err(|_| FactorError::Memory)?;
        values.resize(symbolic.len_val(), 0.0);
        let mut factor = Self { symbolic, values };
        factor.fill(plate, shift)?;
        Ok(factor)
    }

    /// Factors again, for other values on the same pattern.
    pub fn fill(&mut self, plate: &PlateMatrix, shift: f64) -> Result<(), FactorError> {
        let count = plate.scale.len();
        let shifted: Vec<f64>;
        let lower_values = if shift == 0.0 {
            &plate.lower_values
        } else {
            let mut values = plate.lower_values.clone();
            for &first in &plate.lower_offsets[..count] {
                values[first as usize] += shift;
            }
            shifted = values;
            &shifted
        };
        let pattern =
            SymbolicSparseColMatRef::new_unsorted_checked(count, count, &plate.lower_offsets, None, &plate.lower_rows);
        let matrix = SparseColMatRef::new(pattern, lower_values);
        let scratch = supernodal::factorize_supernodal_numeric_llt_scratch::<u32, f64>(
            &self.symbolic,
            Par::Seq,
            Default::default(),
        );
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| FactorError::Memory)?;
        let outcome = supernodal::factorize_supernodal_numeric_llt(
            &mut self.values,
            matrix,
            LltRegularization::default(),
            &self.symbolic,
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        match outcome {
            Ok(_) => Ok(()),
            Err(LltError::NonPositivePivot { index }) => Err(FactorError::Pivot(index)),
        }
    }

    /// How many numbers the factor stores.
    pub fn stored(&self) -> usize {
        self.values.len()
    }

    /// Solves for K right-hand sides in place.
    pub fn solve<const K: usize>(&self, x: &mut [[f64; K]]) {
        triangular::solve_in_place(&self.symbolic, &self.values, x);
    }
}

fn analyse(plate: &PlateMatrix) -> Option<supernodal::SymbolicSupernodalCholesky<u32>> {
    let count = plate.scale.len();
    let pattern =
        SymbolicSparseColMatRef::new_unsorted_checked(count, count, &plate.upper_offsets, None, &plate.upper_rows);
    let mut tree = vec![0_i32; count];
    let mut column_counts = vec![0_u32; count];
    let scratch = simplicial::prefactorize_symbolic_cholesky_scratch::<u32>(count, plate.upper_rows.len());
    let mut memory =
        MemBuffer::try_new(scratch.or(supernodal::factorize_supernodal_symbolic_cholesky_scratch::<u32>(count)))
            .ok()?;
    let tree =
        simplicial::prefactorize_symbolic_cholesky(&mut tree, &mut column_counts, pattern, MemStack::new(&mut memory));
    supernodal::factorize_supernodal_symbolic_cholesky(
        pattern,
        tree,
        &column_counts,
        MemStack::new(&mut memory),
        SymbolicSupernodalParams::default(),
    )
    .ok()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::Factor;
    use crate::Bilaplacian;
    use crate::Laplacian;
    use crate::assembly::{CONSTRAINED, PlateMatrix, assemble_shell};
    use crate::shell_operator::ShellOperator;
    use pliant_mesh::shapes;

    fn plate() -> PlateMatrix {
        let model = shapes::model(shapes::torus(14, 9));
        let count = model.surface.positions.len();
        let laplacian = Laplacian::of(&model.surface, &model.topology, &vec![1.0; count]);
        let columns: Vec<u32> = (0..count as u32).filter(|v| v % 9 != 0).collect();
        let mut column_of = vec![CONSTRAINED; count];
        for (column, &vertex) in columns.iter().enumerate() {
            column_of[vertex as usize] = column as u32;
        }
        let operator = ShellOperator::new(laplacian, &Bilaplacian::default(), 1.0);
        assemble_shell(&operator, &columns, &column_of)
    }

    fn product<const K: usize>(plate: &PlateMatrix, x: &[[f64; K]]) -> Vec<[f64; K]> {
        let mut y = vec![[0.0; K]; x.len()];
        for column in 0..x.len() {
            for entry in plate.lower_offsets[column] as usize..plate.lower_offsets[column + 1] as usize {
                let (row, value) = (plate.lower_rows[entry] as usize, plate.lower_values[entry]);
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
        let plate = plate();
        let factor = Factor::of(&plate, 0.0).unwrap();
        let x: Vec<[f64; K]> = (0..plate.scale.len())
            .map(|i| std::array::from_fn(|k| ((i * 7 + k * 3) % 11) as f64 - 5.0))
            .collect();
        let mut y = product(&plate, &x);
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
        let mut plate = plate();
        let diagonal = plate.lower_offsets[5] as usize;
        plate.lower_values[diagonal] = -1.0;
        let refused = Factor::of(&plate, 0.0).err();
        assert!(
            matches!(refused, Some(super::FactorError::Pivot(column)) if column >= 5),
            "{refused:?}"
        );
    }
}
