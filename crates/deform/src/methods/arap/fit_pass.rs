//! The first pass over the cells: gathers each cell's displaced ring into its matrix S, fits eight cells' rotations at
//! once, and sums the energy. It uses the machine's vectors (see [`crate::numerical::lanes`]).

use std::hint::black_box;

use pulp::{Simd, WithSimd};

use super::barrier::Barriers;
use super::cells::{Cells, Quad, minus};
use super::gradient_pass::{Turn, times_turn};
use super::rotation::Rotation;
use crate::numerical::lane_fits::Fits;
use crate::numerical::lanes::LANES;
use crate::numerical::prefetch::Prefetch;

/// The prefetch distance in entries: about eight cells.
const AHEAD: usize = 48;

/// The choice of the cells' rotations.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Turning {
    /// The best rotations.
    Best,
    /// The rotations at which a fit would start.
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
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        self.cells
            .fit(simd, self.first, self.displacements, self.turning, self.out)
    }
}

/// The destination of a chunk's results.
pub(super) struct Out<'a> {
    pub rotations: &'a mut [Rotation],
    pub turns: &'a mut [Turn],
    pub laplacians: &'a mut [[f32; 4]],
}

impl Cells {
    /// Rotations, turns and Laplacians of the cells from `first` on; their energy.
    #[inline(always)]
    fn fit<S: Simd>(&self, simd: S, first: usize, displacements: &[Quad], turning: Turning, out: Out<'_>) -> f64 {
        let Out {
            rotations,
            turns,
            laplacians,
        } = out;
        let mut sum = 0.0;
        let mut fits = Fits::default();
        let mut barriers = Barriers::default();
        for start in (0..rotations.len()).step_by(LANES) {
            let count = LANES.min(rotations.len() - start);
            let (mut loads, mut forces) = ([[0.0; 4]; LANES], [[[0.0; 4]; 3]; LANES]);
            for lane in 0..count {
                let cell = first + start + lane;
                let (mut b, laplacian, square) = self.gather(cell, displacements);
                loads[lane] = laplacian;
                sum += 0.25 * square;
                if let Some(bend) = self.bending.get(cell) {
                    let held;
                    (forces[lane], held) = bend.bear(&mut b);
                    sum -= held;
                }
                for (lanes, column) in fits.change.iter_mut().zip(b) {
                    for (lanes, value) in lanes.iter_mut().zip(column) {
                        lanes.0[lane] = value;
                    }
                }
                for (lanes, value) in fits.rest.iter_mut().zip(self.rest[cell]) {
                    lanes.0[lane] = value;
                }
                for (lanes, value) in fits.rotation.iter_mut().zip(rotations[start + lane]) {
                    lanes.0[lane] = f64::from(value);
                }
            }
            fits.normalise(simd);
            if turning == Turning::Best {
                fits.fit(simd, count);
            }
            fits.finish(simd);
            if turning == Turning::Best && !self.barriers.is_empty() {
                for lane in 0..count {
                    for (lanes, value) in barriers.facing.iter_mut().zip(self.barriers[first + start + lane]) {
                        lanes.0[lane] = f64::from(value);
                    }
                }
                barriers.resist(simd, &mut fits);
            }
            for lane in 0..count {
                sum -= 2.0 * fits.inner.0[lane];
                sum += barriers.energy.0[lane];
                for (own, lanes) in rotations[start + lane].iter_mut().zip(&fits.rotation) {
                    *own = lanes.0[lane] as f32;
                }
                let mut turn = [[0.0; 4]; 3];
                for (own, column) in turn.iter_mut().zip(&fits.turn) {
                    for (own, lanes) in own.iter_mut().zip(column) {
                        *own = lanes.0[lane];
                    }
                }
                if let Some(bend) = self.bending.get(first + start + lane) {
                    turn = bend.pull(&turn, &forces[lane]);
                }
                if let Some(own) = self.own.get(first + start + lane) {
                    let turned = times_turn(&turn, own);
                    for row in 0..4 {
                        laplacians[start + lane][row] = (loads[lane][row] - turned[row]) as f32;
                    }
                }
                for (own, column) in turns[start + lane].iter_mut().zip(&turn) {
                    for row in 0..4 {
                        own[row] = column[row] as f32;
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
        let prefetch = Prefetch::new();
        for (&end, towards) in self.ends[around.clone()].iter().zip(&self.towards[around.clone()]) {
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
        // Rings of the cells that are fitted next.
        let ahead = around.start + AHEAD..around.end + AHEAD;
        for &end in self.ends.get(ahead).unwrap_or_default() {
            prefetch.item(&displacements[end as usize]);
        }
        // The fourth number is not needed, but without it the compiler splits the vector into a pair and a single
        // number.
        let (b, laplacian, square) = black_box((b, laplacian, square));
        (b, laplacian, square[0] + square[1] + square[2])
    }
}
