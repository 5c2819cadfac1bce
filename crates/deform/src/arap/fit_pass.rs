//! The first pass over the cells: each one's displaced ring becomes its matrix S, eight cells' rotations are fitted at
//! once, and the energy is summed. It runs on whatever vectors the machine has (see [`crate::lanes`]).

use glam::{DMat3, DQuat, DVec3};
use pulp::{Simd, WithSimd};

use super::cells::{Cells, Quad, minus};
use super::gradient_pass::Turn;
use super::shape::Rotation;
use crate::lanes::{self, LANES, Lanes, Matrices, Quaternions};
use crate::rotation::fit_anew;

/// Which rotations cells get.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Turning {
    /// The best ones.
    Best,
    /// Those where a fit would start.
    Given,
}

/// [`Cells::fit`] compiled for the machine's vectors.
pub(super) struct FitPass<'a> {
    pub cells: &'a Cells,
    pub first: usize,
    pub displacements: &'a [Quad],
    pub turning: Turning,
    pub out: Out<'a>,
}

impl WithSimd for FitPass<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        self.cells.fit(self.first, self.displacements, self.turning, self.out)
    }
}

/// Where a chunk's results go.
pub(super) struct Out<'a> {
    pub rotations: &'a mut [Rotation],
    pub turns: &'a mut [Turn],
    pub laplacians: &'a mut [[f32; 4]],
    pub moments: &'a mut [Quad],
}

impl Cells {
    /// Rotations, turns, Laplacians and moments of the cells from `first` on; their energy.
    #[inline(always)]
    fn fit(&self, first: usize, displacements: &[Quad], turning: Turning, out: Out<'_>) -> f64 {
        let Out {
            rotations,
            turns,
            laplacians,
            moments,
        } = out;
        let mut sum = 0.0;
        for start in (0..rotations.len()).step_by(LANES) {
            let count = LANES.min(rotations.len() - start);
            let mut s: Matrices = Default::default();
            let mut axial: [Lanes; 3] = Default::default();
            let mut guess: Quaternions = Default::default();
            guess[3] = Lanes::splat(1.0);
            let mut curvatures = [[0.0; 4]; LANES];
            for lane in 0..count {
                let cell = first + start + lane;
                let (mut b, laplacian, square) = self.gather(cell, displacements);
                laplacians[start + lane] = laplacian.map(|value| value as f32);
                curvatures[lane] = laplacian;
                sum += 0.25 * square;
                let [mut xx, mut xy, mut xz, mut yy, mut yz, mut zz] = self.rest[cell];
                if let Some(&[x, y, z, factor]) = self.bending.get(cell) {
                    for (k, rest) in [x, y, z].into_iter().enumerate() {
                        for row in 0..3 {
                            b[k][row] += factor * laplacian[row] * rest;
                        }
                    }
                    (xx, xy, xz) = (xx + factor * x * x, xy + factor * x * y, xz + factor * x * z);
                    (yy, yz, zz) = (yy + factor * y * y, yz + factor * y * z, zz + factor * z * z);
                    let square =
                        laplacian[0] * laplacian[0] + laplacian[1] * laplacian[1] + laplacian[2] * laplacian[2];
                    sum += 0.5 * factor * square;
                }
                axial[0].0[lane] = b[1][2] - b[2][1];
                axial[1].0[lane] = b[2][0] - b[0][2];
                axial[2].0[lane] = b[0][1] - b[1][0];
                let rest = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
                for column in 0..3 {
                    for row in 0..3 {
                        s[column][row].0[lane] = b[column][row] + rest[column][row];
                    }
                }
                for k in 0..4 {
                    guess[k].0[lane] = f64::from(rotations[start + lane][k]);
                }
            }
            for lane in count..LANES {
                for k in 0..3 {
                    s[k][k].0[lane] = 1.0;
                }
            }
            // What rounding has left of its length: 1 to second order.
            let square = guess[0] * guess[0] + guess[1] * guess[1] + guess[2] * guess[2] + guess[3] * guess[3];
            let length = Lanes::splat(1.5) - Lanes::splat(0.5) * square;
            let guess = guess.map(|value| value * length);
            let mut rotation = guess;
            if turning == Turning::Best {
                let found;
                (rotation, found) = lanes::fit(&s, guess);
                for lane in (0..count).filter(|&lane| !found[lane]) {
                    refit(&s, guess, lane, &mut rotation);
                }
            }
            let [x, y, z, w] = rotation;
            // ⟨R − 1, S⟩ by the quaternion: 2 w (a · v) + 2 (v · S v − |v|² tr S).
            let v = [x, y, z];
            let mut inner = w * (axial[0] * x + axial[1] * y + axial[2] * z);
            let trace = s[0][0] + s[1][1] + s[2][2];
            for k in 0..3 {
                let sv = s[0][k] * x + s[1][k] * y + s[2][k] * z;
                inner = inner + v[k] * (sv - v[k] * trace);
            }
            let turned = lanes::turns(rotation);
            for lane in 0..count {
                sum -= 2.0 * inner.0[lane];
                for k in 0..4 {
                    rotations[start + lane][k] = rotation[k].0[lane] as f32;
                }
                for column in 0..3 {
                    for row in 0..3 {
                        turns[start + lane][column][row] = turned[column][row].0[lane] as f32;
                    }
                }
            }
            if !self.bending.is_empty() {
                for (lane, place) in (start..start + count).enumerate() {
                    let [x, y, z, factor] = self.bending[first + place];
                    for row in 0..3 {
                        let [a, b, c] = [0, 1, 2].map(|column| turned[column][row].0[lane]);
                        moments[place][row] = factor * (curvatures[lane][row] - (a * x + b * y + c * z));
                    }
                }
            }
        }
        sum
    }

    /// B's columns, Σ w D and Σ w |D|² of a cell.
    #[inline(always)]
    fn gather(&self, cell: usize, displacements: &[Quad]) -> ([Quad; 3], Quad, f64) {
        let own = displacements[cell];
        let (mut b, mut laplacian, mut square) = ([[0.0; 4]; 3], [0.0; 4], [0.0; 4]);
        let around = self.around(cell);
        for (&end, towards) in self.ends[around.clone()].iter().zip(&self.towards[around]) {
            let d = minus(displacements[end as usize], own);
            for (k, column) in b.iter_mut().enumerate() {
                for row in 0..4 {
                    column[row] += d[row] * towards[k];
                }
            }
            for row in 0..4 {
                let weighted = d[row] * towards[3];
                laplacian[row] += weighted;
                square[row] += weighted * d[row];
            }
        }
        (b, laplacian, square[0] + square[1] + square[2])
    }
}

/// Fits one lane anew, without a guess.
#[cold]
fn refit(s: &Matrices, guess: Quaternions, lane: usize, rotation: &mut Quaternions) {
    let column = |c: usize| DVec3::new(s[c][0].0[lane], s[c][1].0[lane], s[c][2].0[lane]);
    let matrix = DMat3::from_cols(column(0), column(1), column(2));
    let start = DQuat::from_array(guess.map(|value| value.0[lane]));
    for (own, value) in rotation.iter_mut().zip(fit_anew(&matrix, start).to_array()) {
        own.0[lane] = value;
    }
}
