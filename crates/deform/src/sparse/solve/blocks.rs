//! A supernode's columns in blocks of up to four: their layout, and substitution through one block.
//!
//! A block holds the rows from its own diagonal down, row by row: a row's four numbers are multiplied with four
//! finished values in registers, and rows below are read and written once for four columns.

use crate::numerical::prefetch::Prefetch;
use crate::sparse::line::{Line, Shape};
use crate::sparse::solve::rhs::{Real, Rhs, minus, plus, times};

/// The prefetch distance of the backward substitution, in numbers: some blocks of the usual size.
const AHEAD: usize = 1024;

/// The width of the next block of this many columns.
#[inline(always)]
pub(super) fn block(columns: usize) -> usize {
    match columns {
        0 | 1 => 1,
        2 | 3 => 2,
        _ => 4,
    }
}

/// The width of the last block of this many columns, divided from the front.
#[inline(always)]
pub(super) fn last_block(columns: usize) -> usize {
    match columns % 4 {
        0 => 4,
        2 => 2,
        _ => 1,
    }
}

/// The number of entries in a supernode's blocks.
#[inline(always)]
pub(super) fn numbers(width: usize, height: usize) -> usize {
    let (mut count, mut done) = (0, 0);
    while done < width {
        let block = block(width - done);
        count += block * (height - done);
        done += block;
    }
    count
}

/// Appends a supernode's columns as blocks, diagonals as their inverses.
pub(super) fn copy_node<T: Real>(panel: &[Line], shape: Shape, copied: &mut Vec<T>) {
    let mut done = 0;
    while done < shape.width {
        let block = block(shape.width - done);
        for row in done..shape.width + shape.below {
            let (start, lane) = shape.row(row);
            for column in done..done + block {
                copied.push(if row < column {
                    T::default()
                } else {
                    T::of(panel[start + column].0[lane])
                });
            }
        }
        done += block;
    }
}

/// `rest` starts with the block's own rows.
#[inline(always)]
pub(super) fn forward_block<T: Real, const B: usize>(numbers: &[T], rest: &mut [Rhs<T>], below: &mut [Rhs<T>]) {
    let (triangle, numbers) = numbers.split_at(B * B);
    let (own, rest) = rest.split_at_mut(B);
    let mut values = [Rhs::default(); B];
    values.copy_from_slice(own);
    for c in 0..B {
        values[c] = times(values[c], triangle[c * B + c]);
        for r in c + 1..B {
            values[r] = minus(values[r], times(values[c], triangle[r * B + c]));
        }
    }
    own.copy_from_slice(&values);
    let (inside, outside) = numbers.split_at(rest.len() * B);
    for (row, numbers) in rest.iter_mut().zip(inside.chunks_exact(B)) {
        for c in 0..B {
            *row = minus(*row, times(values[c], numbers[c]));
        }
    }
    for (row, numbers) in below.iter_mut().zip(outside.chunks_exact(B)) {
        for c in 0..B {
            *row = plus(*row, times(values[c], numbers[c]));
        }
    }
}

/// `rest` starts with the block's own rows.
#[inline(always)]
pub(super) fn backward_block<T: Real, const B: usize>(numbers: &[T], rest: &mut [Rhs<T>], below: &[Rhs<T>]) {
    let (triangle, numbers) = numbers.split_at(B * B);
    let (own, rest) = rest.split_at_mut(B);
    let mut sums = [Rhs::default(); B];
    let (inside, outside) = numbers.split_at(rest.len() * B);
    for (row, numbers) in rest.iter().zip(inside.chunks_exact(B)) {
        for c in 0..B {
            sums[c] = plus(sums[c], times(*row, numbers[c]));
        }
    }
    let prefetch = Prefetch::new();
    for (row, numbers) in below.iter().zip(outside.chunks_exact(B)) {
        prefetch.below(&numbers[0], AHEAD);
        for c in 0..B {
            sums[c] = plus(sums[c], times(*row, numbers[c]));
        }
    }
    for c in (0..B).rev() {
        let mut value = minus(own[c], sums[c]);
        for r in c + 1..B {
            value = minus(value, times(own[r], triangle[r * B + c]));
        }
        own[c] = times(value, triangle[c * B + c]);
    }
}
