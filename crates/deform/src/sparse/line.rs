//! Cache lines of numbers, and the layout of a front in them.
//!
//! Rows are grouped in *strips* of eight. A strip holds one line per column: that column's numbers in its eight rows.
//! So one instruction multiplies eight rows by a number of another row, nothing is copied before it is multiplied, and
//! a factor is read in the order in which it is stored.

/// The number of rows of a strip, and of numbers in a line.
pub(crate) const LANES: usize = 8;

/// Numbers of eight rows in one column.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
#[repr(C, align(64))]
pub(crate) struct Line(pub [f64; LANES]);

impl Line {
    /// All zero.
    pub const ZERO: Self = Self([0.0; LANES]);
}

/// The number of strips for this many rows.
#[inline(always)]
pub(crate) fn strips(rows: usize) -> usize {
    rows.div_ceil(LANES)
}

/// The start of a strip of a lower triangle: strip t has the columns up to its own last row.
#[inline(always)]
pub(crate) fn triangle(strip: usize) -> usize {
    LANES / 2 * strip * (strip + 1)
}

/// The columns of a supernode and the rows below them.
///
/// Its own rows come first, as a triangle of strips; then the rows of its pattern, in strips of all its columns. The
/// last strip of each is padded with rows of zeros.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Shape {
    pub width: usize,
    pub below: usize,
}

impl Shape {
    /// Strips of its own rows.
    #[inline(always)]
    pub fn own(self) -> usize {
        strips(self.width)
    }

    /// All its strips.
    #[inline(always)]
    pub fn strips(self) -> usize {
        self.own() + strips(self.below)
    }

    /// Columns of a strip.
    #[inline(always)]
    pub fn columns(self, strip: usize) -> usize {
        self.width.min(LANES * (strip + 1))
    }

    /// The start of a strip.
    #[inline(always)]
    pub fn start(self, strip: usize) -> usize {
        let own = self.own();
        if strip < own {
            return triangle(strip);
        }
        let last = own.saturating_sub(1);
        triangle(last) + (strip - last) * self.width
    }

    /// Lines of all strips.
    #[inline(always)]
    pub fn lines(self) -> usize {
        self.start(self.strips())
    }

    /// The strip's start and the lane of a row: the supernode's own rows come first, then the rows of its pattern.
    #[inline(always)]
    pub fn row(self, place: usize) -> (usize, usize) {
        if place < self.width {
            (self.start(place / LANES), place % LANES)
        } else {
            let row = place - self.width;
            (self.start(self.own() + row / LANES), row % LANES)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LANES, Shape};

    #[test]
    fn strips_follow_one_another_without_gaps() {
        for width in 1..40 {
            for below in [0, 1, 7, 8, 9, 30] {
                let shape = Shape { width, below };
                for strip in 0..shape.strips() {
                    assert_eq!(shape.start(strip) + shape.columns(strip), shape.start(strip + 1));
                }
                for place in 0..width + below {
                    let (start, lane) = shape.row(place);
                    assert!(start < shape.lines() && lane < LANES);
                }
            }
        }
    }
}
