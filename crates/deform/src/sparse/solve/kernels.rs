//! A supernode's triangular solves: the loops that read each line of the factor once.

use pulp::{Simd, WithSimd};

use crate::numerical::prefetch::Prefetch;
use crate::sparse::line::{LANES, Line, Shape};

/// K right-hand sides of eight rows, each a line.
pub(crate) type Strip<const K: usize> = [Line; K];

/// The number of strips that are processed at once: their sums are independent, which hides the latency of an addition.
const STRIPS: usize = 4;

/// The prefetch distance in lines: some supernodes of the usual size.
const AHEAD: usize = 128;

/// The number of columns whose sums are kept in the cache: their lines are consecutive.
const COLUMNS: usize = 64;

/// Solves with a supernode's lower triangle for the first strips of `x`, its own rows, and writes the products of the
/// rows below into the others.
pub(crate) struct Forward<'a, const K: usize> {
    pub shape: Shape,
    pub panel: &'a [Line],
    pub x: &'a mut [Strip<K>],
    /// The solution, row by row, for the rows below.
    pub rows: &'a mut Vec<[f64; K]>,
}

/// Solves with the triangle's transpose for the first strips of `x`, given the others.
pub(crate) struct Backward<'a, const K: usize> {
    pub shape: Shape,
    pub panel: &'a [Line],
    pub x: &'a mut [Strip<K>],
    /// For each column the products of the rows below, lane by lane.
    pub sums: &'a mut Vec<Strip<K>>,
}

#[inline(always)]
fn vectors<S: Simd, const V: usize>(line: &Line) -> [S::f64s; V] {
    let (vectors, _) = S::as_simd_f64s(&line.0);
    std::array::from_fn(|v| vectors[v])
}

/// Σ_k lines_k · rows_k for some strips.
#[inline(always)]
fn gather<S: Simd, const V: usize, const R: usize, const K: usize>(
    simd: S,
    lines: [&[Line]; R],
    rows: &[[f64; K]],
) -> [Strip<K>; R] {
    let mut sums = [[[simd.splat_f64s(0.0); V]; K]; R];
    let lines = lines.map(|lines| &lines[..rows.len()]);
    let prefetch = Prefetch::new();
    for (c, row) in rows.iter().enumerate() {
        let factors = row.map(|value| simd.splat_f64s(value));
        for r in 0..R {
            prefetch.above(&lines[r][c], AHEAD);
            let line = vectors::<S, V>(&lines[r][c]);
            for k in 0..K {
                for v in 0..V {
                    sums[r][k][v] = simd.mul_add_f64s(line[v], factors[k], sums[r][k][v]);
                }
            }
        }
    }
    let mut strips = [[Line::ZERO; K]; R];
    for r in 0..R {
        for k in 0..K {
            let (vectors, _) = S::as_mut_simd_f64s(&mut strips[r][k].0);
            vectors[..V].copy_from_slice(&sums[r][k]);
        }
    }
    strips
}

#[inline(always)]
fn forward<S: Simd, const V: usize, const K: usize>(
    simd: S,
    shape: Shape,
    panel: &[Line],
    x: &mut [Strip<K>],
    rows: &mut Vec<[f64; K]>,
) {
    rows.clear();
    let (own, below) = x.split_at_mut(shape.own());
    for (strip, x) in own.iter_mut().enumerate() {
        let lines = &panel[shape.start(strip)..shape.start(strip + 1)];
        let (left, diagonal) = lines.split_at(LANES * strip);
        let [taken] = gather::<S, V, 1, K>(simd, [left], rows);
        for k in 0..K {
            for lane in 0..LANES {
                x[k].0[lane] -= taken[k].0[lane];
            }
        }
        for (c, line) in diagonal.iter().enumerate() {
            let row: [f64; K] = std::array::from_fn(|k| x[k].0[c] * line.0[c]);
            for k in 0..K {
                for lane in 0..LANES {
                    x[k].0[lane] -= row[k] * line.0[lane];
                }
                x[k].0[c] = row[k];
            }
            rows.push(row);
        }
        // The solved rows are final; this corrects the later columns' subtractions from them.
        for (c, row) in rows[LANES * strip..].iter().enumerate() {
            for k in 0..K {
                x[k].0[c] = row[k];
            }
        }
    }
    let start = shape.start(shape.own());
    let lines = |strip: usize| &panel[start + strip * shape.width..start + (strip + 1) * shape.width];
    let mut strip = 0;
    while strip + STRIPS <= below.len() {
        let group: [&[Line]; STRIPS] = std::array::from_fn(|i| lines(strip + i));
        below[strip..strip + STRIPS].copy_from_slice(&gather::<S, V, STRIPS, K>(simd, group, rows));
        strip += STRIPS;
    }
    for (strip, below) in below.iter_mut().enumerate().skip(strip) {
        [*below] = gather::<S, V, 1, K>(simd, [lines(strip)], rows);
    }
}

/// sums_c += Σ lines_c · x over some strips.
#[inline(always)]
fn spread<S: Simd, const V: usize, const R: usize, const K: usize>(
    simd: S,
    lines: [&[Line]; R],
    x: &[Strip<K>],
    sums: &mut [Strip<K>],
) {
    let lines = lines.map(|lines| &lines[..sums.len()]);
    let prefetch = Prefetch::new();
    let x: [[[S::f64s; V]; K]; R] = std::array::from_fn(|r| std::array::from_fn(|k| vectors::<S, V>(&x[r][k])));
    for (c, sums) in sums.iter_mut().enumerate().rev() {
        let lines: [[S::f64s; V]; R] = std::array::from_fn(|r| {
            prefetch.below(&lines[r][c], AHEAD);
            vectors::<S, V>(&lines[r][c])
        });
        for k in 0..K {
            let (sum, _) = S::as_mut_simd_f64s(&mut sums[k].0);
            for v in 0..V {
                for r in 0..R {
                    sum[v] = simd.mul_add_f64s(lines[r][v], x[r][k][v], sum[v]);
                }
            }
        }
    }
}

#[inline(always)]
fn backward<S: Simd, const V: usize, const K: usize>(
    simd: S,
    shape: Shape,
    panel: &[Line],
    x: &mut [Strip<K>],
    sums: &mut Vec<Strip<K>>,
) {
    sums.clear();
    sums.resize(shape.width, [Line::ZERO; K]);
    let (own, below) = x.split_at_mut(shape.own());
    let start = shape.start(shape.own());
    // The number of columns is chosen so that their sums stay in the cache.
    for first in (0..shape.width).step_by(COLUMNS).rev() {
        let until = (first + COLUMNS).min(shape.width);
        let sums = &mut sums[first..until];
        let lines = |strip: usize| &panel[start + strip * shape.width + first..start + strip * shape.width + until];
        let mut strip = below.len();
        while strip >= STRIPS {
            strip -= STRIPS;
            let group: [&[Line]; STRIPS] = std::array::from_fn(|i| lines(strip + i));
            spread::<S, V, STRIPS, K>(simd, group, &below[strip..strip + STRIPS], sums);
        }
        for strip in (0..strip).rev() {
            spread::<S, V, 1, K>(simd, [lines(strip)], &below[strip..strip + 1], sums);
        }
    }
    for strip in (0..own.len()).rev() {
        let (left, diagonal) = panel[shape.start(strip)..shape.start(strip + 1)].split_at(LANES * strip);
        let (done, sums) = sums.split_at_mut(left.len());
        let x = &mut own[strip];
        for (c, line) in diagonal.iter().enumerate().rev() {
            for k in 0..K {
                let s = &sums[c][k].0;
                let mut value = x[k].0[c] - (((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7])));
                for b in c + 1..diagonal.len() {
                    value -= line.0[b] * x[k].0[b];
                }
                x[k].0[c] = value * line.0[c];
            }
        }
        spread::<S, V, 1, K>(simd, [left], &own[strip..strip + 1], done);
    }
}

impl<const K: usize> WithSimd for Forward<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { shape, panel, x, rows } = self;
        match S::F64_LANES {
            8 => forward::<S, 1, K>(simd, shape, panel, x, rows),
            4 => forward::<S, 2, K>(simd, shape, panel, x, rows),
            2 => forward::<S, 4, K>(simd, shape, panel, x, rows),
            _ => forward::<S, 8, K>(simd, shape, panel, x, rows),
        }
    }
}

impl<const K: usize> WithSimd for Backward<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { shape, panel, x, sums } = self;
        match S::F64_LANES {
            8 => backward::<S, 1, K>(simd, shape, panel, x, sums),
            4 => backward::<S, 2, K>(simd, shape, panel, x, sums),
            2 => backward::<S, 4, K>(simd, shape, panel, x, sums),
            _ => backward::<S, 8, K>(simd, shape, panel, x, sums),
        }
    }
}
