//! The second pass: the turns of a vertex' ring become its gradient, on whatever vectors the machine has.

use pulp::{Simd, WithSimd};

use super::cells::{Cells, Quad, minus};
use crate::prefetch::Prefetch;

/// Entries between those that are gathered and those that are asked for: some cells'.
const AHEAD: usize = 24;

/// R − 1, column by column.
pub(super) type Turn = [[f32; 4]; 3];

/// Where a gradient has the cells' Σ_v w_iv D_v from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Laplacians<'a> {
    /// From the measure.
    Known(&'a [[f32; 4]]),
    /// From these displacements.
    Of(&'a [Quad]),
}

/// [`Cells::descend`] compiled for the machine's vectors.
pub(super) struct GradientPass<'a> {
    pub cells: &'a Cells,
    pub first: usize,
    pub gradient: &'a mut [[f32; 3]],
    pub turns: &'a [Turn],
    pub laplacians: Laplacians<'a>,
    pub moments: &'a [Quad],
}

impl WithSimd for GradientPass<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            cells,
            first,
            gradient,
            turns,
            laplacians,
            moments,
        } = self;
        cells.descend(first, gradient, turns, laplacians, moments);
    }
}

impl Cells {
    /// The gradient of the solved vertices from `first` on.
    #[inline(always)]
    fn descend(
        &self,
        first: usize,
        gradient: &mut [[f32; 3]],
        turns: &[Turn],
        laplacians: Laplacians<'_>,
        moments: &[Quad],
    ) {
        let per_unit = self.unit().recip() as f32;
        let prefetch = Prefetch::new();
        for (place, gradient) in gradient.iter_mut().enumerate() {
            let cell = first + place;
            let around = self.around(cell);
            let ends = &self.ends[around.clone()];
            let mut sum = times_turn(&turns[cell], self.own[cell]);
            for (&end, back) in ends.iter().zip(&self.back[around.clone()]) {
                let term = times_turn(&turns[end as usize], *back);
                for row in 0..4 {
                    sum[row] -= term[row];
                }
            }
            let ahead = around.start + AHEAD..around.end + AHEAD;
            for &end in self.ends.get(ahead).unwrap_or_default() {
                if let Some(turn) = turns.get(end as usize) {
                    prefetch.item(turn);
                }
            }
            let weighted = |field: &[Quad]| {
                let mut sum = [0.0; 4];
                for (&end, towards) in ends.iter().zip(&self.towards[around.clone()]) {
                    let d = minus(field[end as usize], field[cell]);
                    for row in 0..4 {
                        sum[row] += d[row] * towards[3];
                    }
                }
                sum.map(|value| value as f32)
            };
            let laplacian = match laplacians {
                Laplacians::Known(laplacians) => laplacians[cell],
                Laplacians::Of(displacements) => weighted(displacements),
            };
            for row in 0..4 {
                sum[row] -= laplacian[row];
            }
            if !moments.is_empty() {
                let moment = weighted(moments);
                for row in 0..4 {
                    sum[row] += moment[row];
                }
            }
            for row in 0..3 {
                gradient[row] = sum[row] * per_unit;
            }
        }
    }
}

/// (R − 1) v; the fourth number is nothing.
#[inline(always)]
fn times_turn([a, b, c]: &Turn, v: [f32; 3]) -> [f32; 4] {
    std::array::from_fn(|row| a[row] * v[0] + b[row] * v[1] + c[row] * v[2])
}
