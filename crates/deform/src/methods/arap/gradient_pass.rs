//! The second pass: gathers the rotations of a vertex' ring into its gradient, on the machine's vectors.

use glam::DVec3;
use pulp::{Simd, WithSimd};

use super::cells::{Cells, Quad, minus};
use super::rotation::Rotation;
use crate::numerical::prefetch::Prefetch;

/// The prefetch distance in entries: some cells.
const AHEAD: usize = 24;

/// R − 1, or Z if cells bend, column by column.
pub(super) type Turn = [[f32; 4]; 3];

/// The source of the gradient's term Σ_v w_iv D_v − (R_i − 1) Σ_v (G_iv − G_vi) of the cells.
#[derive(Clone, Copy, Debug)]
pub(super) enum Laplacians<'a> {
    /// The last measurement.
    Known(&'a [[f32; 4]]),
    /// These displacements.
    Of(&'a [Quad]),
}

/// [`Cells::descend`] compiled for the machine's vectors.
pub(super) struct GradientPass<'a> {
    pub cells: &'a Cells,
    pub first: usize,
    pub gradient: &'a mut [[f32; 3]],
    pub turns: &'a [Turn],
    pub laplacians: Laplacians<'a>,
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
        } = self;
        cells.descend(first, gradient, turns, laplacians);
    }
}

impl Cells {
    /// The gradient of the solved vertices from `first` on.
    #[inline(always)]
    fn descend(&self, first: usize, gradient: &mut [[f32; 3]], turns: &[Turn], laplacians: Laplacians<'_>) {
        let per_unit = self.unit().recip() as f32;
        let prefetch = Prefetch::new();
        for (place, gradient) in gradient.iter_mut().enumerate() {
            let cell = first + place;
            let around = self.around(cell);
            let ends = &self.ends[around.clone()];
            let (mut sum, here) = ([0.0; 4], turns[cell]);
            for (&end, [x, y, z]) in ends.iter().zip(&self.back[around.clone()]) {
                let there = &turns[end as usize];
                for row in 0..4 {
                    sum[row] += (there[0][row] - here[0][row]) * x
                        + (there[1][row] - here[1][row]) * y
                        + (there[2][row] - here[2][row]) * z;
                }
            }
            let ahead = around.start + AHEAD..around.end + AHEAD;
            for &end in self.ends.get(ahead).unwrap_or_default() {
                if let Some(turn) = turns.get(end as usize) {
                    prefetch.item(turn);
                }
                if let Laplacians::Of(displacements) = laplacians {
                    prefetch.item(&displacements[end as usize]);
                }
            }
            let laplacian = match laplacians {
                Laplacians::Known(laplacians) => laplacians[cell],
                Laplacians::Of(displacements) => {
                    let mut sum = [0.0; 4];
                    for (&end, &weight) in ends.iter().zip(&self.weights[around]) {
                        let d = minus(displacements[end as usize], displacements[cell]);
                        for row in 0..4 {
                            sum[row] += d[row] * f64::from(weight);
                        }
                    }
                    let mut turn = [[0.0; 4]; 3];
                    for (wide, column) in turn.iter_mut().zip(&here) {
                        for row in 0..4 {
                            wide[row] = f64::from(column[row]);
                        }
                    }
                    let turned = times_turn(&turn, &self.own[cell]);
                    let mut laplacian = [0.0; 4];
                    for row in 0..4 {
                        laplacian[row] = (sum[row] - turned[row]) as f32;
                    }
                    laplacian
                }
            };
            for row in 0..3 {
                gradient[row] = -(sum[row] + laplacian[row]) * per_unit;
            }
        }
    }
}

/// R − 1: near the identity it keeps its digits.
#[inline]
pub(super) fn turn_of([x, y, z, w]: Rotation) -> Turn {
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (w * x2, w * y2, w * z2);
    [
        [-(yy + zz), xy + wz, xz - wy, 0.0],
        [xy - wz, -(xx + zz), yz + wx, 0.0],
        [xz + wy, yz - wx, -(xx + yy), 0.0],
    ]
}

/// (R − 1) v; the fourth number is 0.
#[inline(always)]
pub(super) fn times_turn([a, b, c]: &[Quad; 3], v: &DVec3) -> Quad {
    let mut product = [0.0; 4];
    for row in 0..4 {
        product[row] = a[row] * v.x + b[row] * v.y + c[row] * v.z;
    }
    product
}
