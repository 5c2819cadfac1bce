//! The sparse Cholesky factor: faer's supernodal L Lᵀ in the order that the matrix already has.
//!
//! Symbolic and numeric parts are two steps, since the pattern outlives the values. Sequential inside (`Par::Seq`).

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
