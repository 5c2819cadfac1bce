//! The dense factorisation of one supernode, and its contribution matrix.
//!
//! The factorisation is left-looking: for a strip's next eight columns all columns before them are multiplied at once,
//! in registers. Large fronts are cut, by size alone, into runs of strips that are processed in parallel.

use pliant_mesh::{Cancel, vectors};
use pulp::{Arch, Simd, WithSimd};

use crate::sparse::factor_error::FactorError;
use crate::sparse::line::{LANES, Line, Shape, triangle};
use crate::sparse::numeric::tiles::{finish_diagonal, finish_strips, square_strips};

/// The number of strips of columns that are finished at once.
const BLOCK: usize = 8;

/// The number of multiplications that justify a separate task.
const TASK: usize = 1 << 20;

/// Factors a supernode's `panel`, which has this shape. The error is the column of the pivot that is not positive.
pub(crate) fn factor_panel(shape: Shape, panel: &mut [Line], cancel: &Cancel) -> Result<(), FactorError> {
    let arch = vectors();
    for first in (0..shape.own()).step_by(BLOCK) {
        if cancel.is_cancelled() {
            return Err(FactorError::Cancelled);
        }
        let blocks = first..(first + BLOCK).min(shape.own());
        let (head, tail) = panel.split_at_mut(shape.start(blocks.end));
        arch.dispatch(Diagonal {
            shape,
            head,
            blocks: blocks.clone(),
        })?;
        let strips = blocks.end..shape.strips();
        finish_rows(arch, shape, head, &blocks, strips, tail);
    }
    Ok(())
}

/// The strips of some successive columns' own rows.
struct Diagonal<'a> {
    shape: Shape,
    head: &'a mut [Line],
    blocks: std::ops::Range<usize>,
}

impl WithSimd for Diagonal<'_> {
    type Output = Result<(), FactorError>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        for block in self.blocks.clone() {
            let (done, rest) = self.head.split_at_mut(self.shape.start(block + 1));
            let own = &mut done[self.shape.start(block)..];
            finish_diagonal(simd, own, block)?;
            finish_strips(simd, self.shape, block + 1, rest, own, block);
        }
        Ok(())
    }
}

/// Finishes some columns of `strips`, which are `rows`.
fn finish_rows(
    arch: Arch,
    shape: Shape,
    head: &[Line],
    blocks: &std::ops::Range<usize>,
    strips: std::ops::Range<usize>,
    rows: &mut [Line],
) {
    let work = strips.len() * LANES * LANES * blocks.len() * LANES * blocks.end;
    if work > TASK && strips.len() >= 6 {
        // Three at a time, like tiles.
        let middle = strips.start + (strips.len() / 6) * 3;
        let (upper, lower) = rows.split_at_mut(shape.start(middle) - shape.start(strips.start));
        rayon::join(
            || finish_rows(arch, shape, head, blocks, strips.start..middle, upper),
            || finish_rows(arch, shape, head, blocks, middle..strips.end, lower),
        );
        return;
    }
    arch.dispatch(Rows {
        shape,
        head,
        blocks: blocks.clone(),
        strips,
        rows,
    });
}

struct Rows<'a> {
    shape: Shape,
    head: &'a [Line],
    blocks: std::ops::Range<usize>,
    strips: std::ops::Range<usize>,
    rows: &'a mut [Line],
}

impl WithSimd for Rows<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        // A few strips at a time stay in the cache while all the blocks are applied to them.
        let mut rest = self.rows;
        for first in self.strips.clone().step_by(3) {
            let end = (first + 3).min(self.strips.end);
            let (group, tail) = rest.split_at_mut(self.shape.start(end) - self.shape.start(first));
            rest = tail;
            for block in self.blocks.clone() {
                let other = &self.head[self.shape.start(block)..self.shape.start(block + 1)];
                finish_strips(simd, self.shape, first, group, other, block);
            }
        }
    }
}

/// Writes the contribution (update) matrix of a factored panel into `square`: the lower triangle of L Lᵀ of the rows
/// below.
pub(crate) fn update_matrix(shape: Shape, panel: &[Line], square: &mut [Line], cancel: &Cancel) {
    let below = &panel[shape.start(shape.own())..];
    let strips = 0..shape.strips() - shape.own();
    square_rows(vectors(), below, shape.width, strips, square, cancel);
}

fn square_rows(
    arch: Arch,
    below: &[Line],
    width: usize,
    strips: std::ops::Range<usize>,
    target: &mut [Line],
    cancel: &Cancel,
) {
    if cancel.is_cancelled() {
        return;
    }
    if target.len() * LANES * width > TASK && strips.len() >= 6 {
        // Half of the lines are on either side, three at a time.
        let half = (triangle(strips.start) + triangle(strips.end)) / 2;
        let mut middle = strips.start + 3;
        while middle + 6 <= strips.end && triangle(middle) < half {
            middle += 3;
        }
        let (upper, lower) = target.split_at_mut(triangle(middle) - triangle(strips.start));
        rayon::join(
            || square_rows(arch, below, width, strips.start..middle, upper, cancel),
            || square_rows(arch, below, width, middle..strips.end, lower, cancel),
        );
        return;
    }
    arch.dispatch(Square {
        below,
        width,
        first: strips.start,
        target,
    });
}

struct Square<'a> {
    below: &'a [Line],
    width: usize,
    first: usize,
    target: &'a mut [Line],
}

impl WithSimd for Square<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        square_strips(simd, self.below, self.width, self.first, self.target);
    }
}
