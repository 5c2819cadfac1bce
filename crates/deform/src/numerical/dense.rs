//! Small dense systems, by faer.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt;
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{Mat, Par};

/// A square matrix, factored by Gaussian elimination with row pivoting. It runs on one thread, so that the bits do not
/// depend on the number of threads.
#[derive(Debug)]
pub(crate) struct Lu {
    factors: Mat<f64>,
    rows: Vec<usize>,
    rows_inverse: Vec<usize>,
}

impl Lu {
    /// The factors of this matrix. A singular one gives solutions that are not finite.
    pub fn of(mut a: Mat<f64>) -> Self {
        let size = a.nrows();
        let (mut rows, mut rows_inverse) = (vec![0_usize; size], vec![0_usize; size]);
        let parameters = Default::default();
        let scratch = factor::lu_in_place_scratch::<usize, f64>(size, size, Par::Seq, parameters);
        let mut room = MemBuffer::new(scratch);
        let room = MemStack::new(&mut room);
        factor::lu_in_place(a.as_mut(), &mut rows, &mut rows_inverse, Par::Seq, room, parameters);
        Self {
            factors: a,
            rows,
            rows_inverse,
        }
    }

    /// A⁻¹ B.
    pub fn solved(&self, mut b: Mat<f64>) -> Mat<f64> {
        if b.ncols() == 0 {
            return b;
        }
        let size = self.rows.len();
        let scratch = solve::solve_in_place_scratch::<usize, f64>(size, b.ncols(), Par::Seq);
        let mut room = MemBuffer::new(scratch);
        let room = MemStack::new(&mut room);
        let rows = PermRef::new_checked(&self.rows, &self.rows_inverse, size);
        solve::solve_in_place(
            self.factors.as_ref(),
            self.factors.as_ref(),
            rows,
            b.as_mut(),
            Par::Seq,
            room,
        );
        b
    }
}

/// Returns true if a symmetric matrix is positive definite, so that it has a Cholesky factor.
pub(crate) fn is_positive_definite(mut a: Mat<f64>) -> bool {
    let scratch = llt::factor::cholesky_in_place_scratch::<f64>(a.nrows(), Par::Seq, Default::default());
    let mut room = MemBuffer::new(scratch);
    let room = MemStack::new(&mut room);
    let (a, none) = (a.as_mut(), Default::default());
    llt::factor::cholesky_in_place(a, none, Par::Seq, room, Default::default()).is_ok()
}

/// A⁻¹ B for a square matrix, as [`Lu`] solves it.
pub(crate) fn solved(a: Mat<f64>, b: Mat<f64>) -> Mat<f64> {
    Lu::of(a).solved(b)
}
