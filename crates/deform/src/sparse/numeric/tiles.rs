//! Products of strips, in registers: the loops in which a factorisation spends its time.
//!
//! A tile is some strips by some columns of another strip's rows. Each of its sums runs over all columns in order, so
//! the bits do not depend on how a front is cut into tiles, nor on the vectors, which decide how large tiles are.

use pulp::Simd;

use crate::sparse::factor_error::FactorError;
use crate::sparse::line::{LANES, Line, Shape, triangle};

/// A tile's sums: for each column, for each strip, V vectors of rows.
type Tile<T, const V: usize, const R: usize, const C: usize> = [[[T; V]; R]; C];

#[inline(always)]
fn vectors<S: Simd, const V: usize>(line: &Line) -> [S::f64s; V] {
    let (vectors, _) = S::as_simd_f64s(&line.0);
    std::array::from_fn(|v| vectors[v])
}

#[inline(always)]
fn store<S: Simd, const V: usize>(line: &mut Line, values: [S::f64s; V]) {
    let (vectors, _) = S::as_mut_simd_f64s(&mut line.0);
    vectors[..V].copy_from_slice(&values);
}

/// Σ_k rows_k · (the rows from `first` on of `other`)_k.
#[inline(always)]
fn product<S: Simd, const V: usize, const R: usize, const C: usize>(
    simd: S,
    rows: [&[Line]; R],
    other: &[Line],
    first: usize,
) -> Tile<S::f64s, V, R, C> {
    let mut sums = [[[simd.splat_f64s(0.0); V]; R]; C];
    let rows = rows.map(|row| &row[..other.len()]);
    for k in 0..other.len() {
        let left: [[S::f64s; V]; R] = std::array::from_fn(|r| vectors::<S, V>(&rows[r][k]));
        for c in 0..C {
            let factor = simd.splat_f64s(other[k].0[first + c]);
            for r in 0..R {
                for v in 0..V {
                    sums[c][r][v] = simd.mul_add_f64s(left[r][v], factor, sums[c][r][v]);
                }
            }
        }
    }
    sums
}

/// Writes rows · (eight rows of another strip)ᵀ into eight columns of each row's target.
#[inline(always)]
fn multiply<S: Simd, const V: usize, const R: usize, const C: usize>(
    simd: S,
    rows: [&[Line]; R],
    other: &[Line],
    targets: [&mut [Line]; R],
) {
    for first in (0..LANES).step_by(C) {
        let sums: Tile<S::f64s, V, R, C> = product::<S, V, R, C>(simd, rows, other, first);
        for r in 0..R {
            for c in 0..C {
                store::<S, V>(&mut targets[r][first + c], sums[c][r]);
            }
        }
    }
}

/// Finishes the columns from 8 `block` on of some strips, given the same of the block's own strip, `other`, whose
/// diagonal has its inverses. The contributions of earlier columns are summed first and subtracted at once; the block's
/// own columns are subtracted one by one. This order is the same for any number of them in a tile.
#[inline(always)]
fn finish<S: Simd, const V: usize, const R: usize, const C: usize>(
    simd: S,
    rows: [&mut [Line]; R],
    other: &[Line],
    block: usize,
) {
    let done = LANES * block;
    let count = (other.len() - done).min(LANES);
    for first in (0..count).step_by(C) {
        let until = done + first;
        let sums: Tile<S::f64s, V, R, C> =
            product::<S, V, R, C>(simd, rows.each_ref().map(|row| &row[..done]), &other[..done], first);
        let mut values = sums;
        for c in 0..C {
            if first + c >= count {
                break;
            }
            let (before, column) = other[done..until + c + 1].split_at(first);
            for r in 0..R {
                let own = vectors::<S, V>(&rows[r][until + c]);
                for v in 0..V {
                    values[c][r][v] = simd.sub_f64s(own[v], sums[c][r][v]);
                }
            }
            for b in 0..first {
                let factor = simd.splat_f64s(-before[b].0[first + c]);
                for r in 0..R {
                    let finished = vectors::<S, V>(&rows[r][done + b]);
                    for v in 0..V {
                        values[c][r][v] = simd.mul_add_f64s(finished[v], factor, values[c][r][v]);
                    }
                }
            }
            for b in 0..c {
                let factor = simd.splat_f64s(-column[b].0[first + c]);
                for r in 0..R {
                    for v in 0..V {
                        values[c][r][v] = simd.mul_add_f64s(values[b][r][v], factor, values[c][r][v]);
                    }
                }
            }
            let inverse = simd.splat_f64s(column[c].0[first + c]);
            for r in 0..R {
                for v in 0..V {
                    values[c][r][v] = simd.mul_f64s(values[c][r][v], inverse);
                }
                store::<S, V>(&mut rows[r][until + c], values[c][r]);
            }
        }
    }
}

/// Splits the next strip's lines off.
#[inline(always)]
fn next<'a>(rest: &mut &'a mut [Line], lines: usize) -> &'a mut [Line] {
    let (strip, tail) = std::mem::take(rest).split_at_mut(lines);
    *rest = tail;
    strip
}

/// Finishes eight columns of successive strips, `rest`, the first of which is `first`.
#[inline(always)]
pub(crate) fn finish_strips<S: Simd>(
    simd: S,
    shape: Shape,
    first: usize,
    rest: &mut [Line],
    other: &[Line],
    block: usize,
) {
    let mut rest = rest;
    let mut strip = first;
    if S::F64_LANES == LANES {
        while strip + 3 <= shape.strips() && !rest.is_empty() {
            if rest.len() < shape.start(strip + 3) - shape.start(strip) {
                break;
            }
            let group = [0, 1, 2].map(|i| next(&mut rest, shape.columns(strip + i)));
            finish::<S, 1, 3, 8>(simd, group, other, block);
            strip += 3;
        }
    }
    while !rest.is_empty() {
        let group = [next(&mut rest, shape.columns(strip))];
        match S::F64_LANES {
            8 => finish::<S, 1, 1, 8>(simd, group, other, block),
            4 => finish::<S, 2, 1, 4>(simd, group, other, block),
            2 => finish::<S, 4, 1, 4>(simd, group, other, block),
            _ => finish::<S, 8, 1, 1>(simd, group, other, block),
        }
        strip += 1;
    }
}

/// Factors the eight columns of a strip on its own rows. The error is the column of the pivot that is not positive.
#[inline(always)]
pub(crate) fn finish_diagonal<S: Simd>(simd: S, strip: &mut [Line], block: usize) -> Result<(), FactorError> {
    let done = LANES * block;
    let (left, own) = strip.split_at_mut(done);
    let mut sums = [Line::ZERO; LANES];
    let targets = [sums.as_mut_slice()];
    match S::F64_LANES {
        8 => multiply::<S, 1, 1, 8>(simd, [left], left, targets),
        4 => multiply::<S, 2, 1, 4>(simd, [left], left, targets),
        2 => multiply::<S, 4, 1, 4>(simd, [left], left, targets),
        _ => multiply::<S, 8, 1, 1>(simd, [left], left, targets),
    }
    let count = own.len();
    for c in 0..count {
        for lane in 0..LANES {
            sums[c].0[lane] = own[c].0[lane] - sums[c].0[lane];
        }
    }
    for c in 0..count {
        let pivot = sums[c].0[c];
        if pivot <= 0.0 || pivot.is_nan() {
            return Err(FactorError::Pivot(done + c));
        }
        let inverse = pivot.sqrt().recip();
        let mut column = sums[c].0;
        for lane in 0..LANES {
            column[lane] = if lane < c { 0.0 } else { column[lane] * inverse };
        }
        for b in c + 1..count {
            let factor = column[b];
            for lane in 0..LANES {
                sums[b].0[lane] -= column[lane] * factor;
            }
        }
        // Every use of the diagonal needs its inverse.
        column[c] = inverse;
        own[c] = Line(column);
    }
    // Rows that only pad the strip stay zero.
    for line in own.iter_mut() {
        for lane in count..LANES {
            line.0[lane] = 0.0;
        }
    }
    Ok(())
}

/// Writes the strips from `first` on of the lower triangle of below · belowᵀ, `width` columns, into `targets`.
#[inline(always)]
pub(crate) fn square_strips<S: Simd>(simd: S, below: &[Line], width: usize, first: usize, targets: &mut [Line]) {
    let mut rest = targets;
    let mut strip = first;
    let row = |strip: usize| &below[strip * width..(strip + 1) * width];
    let lines = |strip: usize| triangle(strip + 1) - triangle(strip);
    if S::F64_LANES == LANES {
        while rest.len() >= lines(strip) + lines(strip + 1) + lines(strip + 2) {
            let [one, two, three] = [0, 1, 2].map(|i| next(&mut rest, lines(strip + i)));
            let rows = [0, 1, 2].map(|i| row(strip + i));
            for v in 0..=strip {
                let columns = LANES * v..LANES * (v + 1);
                let tile = [
                    &mut one[columns.clone()],
                    &mut two[columns.clone()],
                    &mut three[columns],
                ];
                multiply::<S, 1, 3, 8>(simd, rows, row(v), tile);
            }
            let columns = LANES * (strip + 1)..LANES * (strip + 2);
            let tile = [&mut two[columns.clone()], &mut three[columns]];
            multiply::<S, 1, 2, 8>(simd, [rows[1], rows[2]], rows[1], tile);
            let columns = LANES * (strip + 2)..LANES * (strip + 3);
            multiply::<S, 1, 1, 8>(simd, [rows[2]], rows[2], [&mut three[columns]]);
            strip += 3;
        }
    }
    while !rest.is_empty() {
        let one = next(&mut rest, lines(strip));
        for v in 0..=strip {
            let tile = [&mut one[LANES * v..LANES * (v + 1)]];
            match S::F64_LANES {
                8 => multiply::<S, 1, 1, 8>(simd, [row(strip)], row(v), tile),
                4 => multiply::<S, 2, 1, 4>(simd, [row(strip)], row(v), tile),
                2 => multiply::<S, 4, 1, 4>(simd, [row(strip)], row(v), tile),
                _ => multiply::<S, 8, 1, 1>(simd, [row(strip)], row(v), tile),
            }
        }
        strip += 1;
    }
}
