//! The second pass: the turns of a vertex' ring become its gradient, on whatever vectors the machine has.

use pulp::{Simd, WithSimd};

use super::cells::{Cells, Quad, minus};

/// R − 1, column by column.
pub(super) type Turn = [[f32; 4]; 3];

/// Where a gradient has the cells' Σ_v w_iv D_v from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Laplacians<'a> {
    /// From the measure.
    Known(&'a [Quad]),
    /// From these displacements, with weights in single precision.
    Of(&'a [Quad]),
}

/// [`Cells::descend`] compiled for the machine's vectors.
pub(super) struct GradientPass<'a> {
    pub cells: &'a Cells,
    pub first: usize,
    pub gradient: &'a mut [Quad],
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
        gradient: &mut [Quad],
        turns: &[Turn],
        laplacians: Laplacians<'_>,
        moments: &[Quad],
    ) {
        for (place, gradient) in gradient.iter_mut().enumerate() {
            let cell = first + place;
            let mut sum = times_turn(&turns[cell], self.own[cell]);
            let around = self.around(cell);
            let entries = self.ends[around.clone()].iter().zip(&self.back[around.clone()]);
            match laplacians {
                Laplacians::Known(laplacians) => {
                    sum = minus(sum, laplacians[cell]);
                    for (&end, &back) in entries {
                        sum = minus(sum, times_turn(&turns[end as usize], back.map(f64::from)));
                    }
                }
                Laplacians::Of(displacements) => {
                    let own = displacements[cell];
                    for (&end, &back) in entries {
                        sum = minus(sum, times_turn(&turns[end as usize], back.map(f64::from)));
                        let d = minus(displacements[end as usize], own);
                        sum = minus(sum, d.map(|value| value * f64::from(back[3])));
                    }
                }
            }
            if !moments.is_empty() {
                let own = moments[cell];
                for (&end, back) in self.ends[around.clone()].iter().zip(&self.back[around]) {
                    let other = minus(moments[end as usize], own);
                    for row in 0..4 {
                        sum[row] += other[row] * f64::from(back[3]);
                    }
                }
            }
            sum[3] = 0.0;
            *gradient = sum;
        }
    }
}

/// (R − 1) v; the fourth number is nothing.
#[inline(always)]
fn times_turn(turn: &Turn, v: Quad) -> Quad {
    let mut product = [0.0; 4];
    for row in 0..4 {
        let [a, b, c] = turn.map(|column| f64::from(column[row]));
        product[row] = a * v[0] + b * v[1] + c * v[2];
    }
    product
}
