//! Small dense systems, by faer.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::{Mat, Par};

/// A⁻¹ B for a square matrix, by Gaussian elimination with row pivoting. What is singular gives numbers that are not
/// finite. On one thread, so that the bits do not depend on how many there are.
pub(crate) fn solved(mut a: Mat<f64>, mut b: Mat<f64>) -> Mat<f64> {
    let size = a.nrows();
    let (mut rows, mut rows_inverse) = (vec![0_usize; size], vec![0_usize; size]);
    let parameters = Default::default();
    let scratch = factor::lu_in_place_scratch::<usize, f64>(size, size, Par::Seq, parameters)
        .or(solve::solve_in_place_scratch::<usize, f64>(size, b.ncols(), Par::Seq));
    let mut room = MemBuffer::new(scratch);
    let room = MemStack::new(&mut room);
    let (_, rows) = factor::lu_in_place(a.as_mut(), &mut rows, &mut rows_inverse, Par::Seq, room, parameters);
    solve::solve_in_place(a.as_ref(), a.as_ref(), rows, b.as_mut(), Par::Seq, room);
    b
}
