//! The dense part of one supernode: its columns factored, and what they take from the rows below.
//!
//! Blocks have fixed sizes and each is computed by one sequential call, so the bits don't depend on the number of
//! threads; on large supernodes the blocks are computed beside each other.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, MatRef, Par};
use pliant_mesh::Cancel;

use crate::sparse::cholesky::FactorError;

/// Columns that are factored or updated at once.
const BLOCK: usize = 96;

/// Rows that one triangular solve takes.
const ROWS: usize = 256;

/// Up to this width a supernode is factored by plain loops: library calls cost more than they save.
const NARROW: usize = 4;

/// Factors the supernode's `panel`, `width` columns of `stride` numbers each of which the first `height` are rows, and
/// subtracts L Lᵀ of the rows below the first `width` from the lower triangle of `update`, whose columns are
/// `update_stride` apart. A pivot that fails is named by its place in the panel.
pub(crate) fn eliminate(
    panel: &mut [f64],
    height: usize,
    width: usize,
    stride: usize,
    update: &mut [f64],
    update_stride: usize,
    cancel: &Cancel,
) -> Result<(), FactorError> {
    if width <= NARROW {
        return eliminate_narrow(panel, height, width, stride, update, update_stride);
    }
    let mut matrix = MatMut::from_column_major_slice_with_stride_mut(panel, height, width, stride);
    factor_panel(matrix.rb_mut(), cancel)?;
    let size = height - width;
    if size == 0 {
        return Ok(());
    }
    let below = matrix.rb().get(width.., ..);
    let update = MatMut::from_column_major_slice_with_stride_mut(update, size, size, update_stride);
    subtract_square(update, below, cancel);
    if cancel.is_cancelled() {
        return Err(FactorError::Cancelled);
    }
    Ok(())
}

fn eliminate_narrow(
    panel: &mut [f64],
    height: usize,
    width: usize,
    stride: usize,
    update: &mut [f64],
    update_stride: usize,
) -> Result<(), FactorError> {
    for j in 0..width {
        let (done, rest) = panel.split_at_mut((j + 1) * stride);
        let column = &mut done[j * stride + j..j * stride + height];
        let pivot = column[0];
        if pivot <= 0.0 || pivot.is_nan() {
            return Err(FactorError::Pivot(j));
        }
        let root = pivot.sqrt();
        let inverse = root.recip();
        column[0] = root;
        for value in &mut column[1..] {
            *value *= inverse;
        }
        for (k, target) in rest.chunks_mut(stride).take(width - j - 1).enumerate() {
            subtract(&mut target[j + 1 + k..height], &column[k + 1..], column[k + 1]);
        }
    }
    let size = height - width;
    for (c, target) in update.chunks_mut(update_stride.max(1)).take(size).enumerate() {
        for column in panel.chunks(stride).take(width) {
            let rows = &column[width + c..height];
            subtract(&mut target[c..size], rows, rows[0]);
        }
    }
    Ok(())
}

fn subtract(target: &mut [f64], source: &[f64], factor: f64) {
    for (target, &source) in target.iter_mut().zip(source) {
        *target -= factor * source;
    }
}

fn factor_panel(mut panel: MatMut<f64>, cancel: &Cancel) -> Result<(), FactorError> {
    let (height, width) = (panel.nrows(), panel.ncols());
    let mut memory = MemBuffer::try_new(cholesky_in_place_scratch::<f64>(
        BLOCK.min(width),
        Par::Seq,
        Default::default(),
    ))
    .map_err(|_| FactorError::Memory)?;
    for first in (0..width).step_by(BLOCK) {
        if cancel.is_cancelled() {
            return Err(FactorError::Cancelled);
        }
        let block = BLOCK.min(width - first);
        let rest = panel
            .rb_mut()
            .submatrix_mut(first, first, height - first, width - first);
        let (columns, right) = rest.split_at_col_mut(block);
        let (mut diagonal, mut below) = columns.split_at_row_mut(block);
        let outcome = cholesky_in_place(
            diagonal.rb_mut(),
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        if let Err(LltError::NonPositivePivot { index }) = outcome {
            return Err(FactorError::Pivot(first + index));
        }
        solve_rows(below.rb_mut(), diagonal.rb());
        let (_, trailing) = right.split_at_row_mut(block);
        subtract_square(trailing, below.rb(), cancel);
    }
    Ok(())
}

/// rows ← rows L⁻ᵀ.
fn solve_rows(rows: MatMut<f64>, triangle: MatRef<f64>) {
    if rows.nrows() <= ROWS {
        solve_lower_triangular_in_place(triangle, rows.transpose_mut(), Par::Seq);
        return;
    }
    let half = (rows.nrows() / ROWS).div_ceil(2) * ROWS;
    let (upper, lower) = rows.split_at_row_mut(half);
    rayon::join(|| solve_rows(upper, triangle), || solve_rows(lower, triangle));
}

/// The lower part of target −= below · belowᵀ, for as many of its columns as `target` has.
fn subtract_square(target: MatMut<f64>, below: MatRef<f64>, cancel: &Cancel) {
    subtract_columns(target, below, 0, cancel);
}

fn subtract_columns(target: MatMut<f64>, below: MatRef<f64>, first: usize, cancel: &Cancel) {
    let count = target.ncols();
    if count > BLOCK {
        let half = (count / BLOCK).div_ceil(2) * BLOCK;
        let (left, right) = target.split_at_col_mut(half);
        rayon::join(
            || subtract_columns(left, below, first, cancel),
            || subtract_columns(right, below, first + half, cancel),
        );
        return;
    }
    if count == 0 || cancel.is_cancelled() {
        return;
    }
    let rows = target.nrows() - first;
    let target = target.submatrix_mut(first, 0, rows, count);
    let factors = below.submatrix(first, 0, count, below.ncols());
    let below = below.submatrix(first, 0, rows, below.ncols());
    matmul(target, Accum::Add, below, factors.transpose(), -1.0, Par::Seq);
}
