//! The linear shell's operator A = k_s (−L) + k_b (−L)(−M⁻¹ L)ⁿ⁻¹, applied by differences along edges.
//!
//! One factor −L stands outermost in both terms, so A d = −L φ with φ = k_s d + k_b (−M⁻¹ L)ⁿ⁻¹ d: zero on constants
//! to the last bit at every order.

use rayon::prelude::*;

use crate::operators::CHUNK;
use crate::{Bilaplacian, Laplacian};

/// A over the local vertices of its Laplacian, which has full rows around everything that moves.
#[derive(Debug)]
pub(crate) struct ShellOperator {
    pub laplacian: Laplacian,
    /// n: how many times L stands in the second term.
    pub power: u32,
    /// k_s over the squared diagonal.
    pub stretching: f64,
    /// k_b times the diagonal to the power 2 (n − 2).
    pub bending: f64,
}

impl ShellOperator {
    /// With the options' coefficients for a surface of this diagonal.
    pub fn new(laplacian: Laplacian, options: &Bilaplacian, diagonal: f64) -> Self {
        let square = if diagonal > 0.0 { diagonal * diagonal } else { 1.0 };
        let power = options.operator_power();
        let bending = match power {
            1 => options.bending / square,
            2 => options.bending,
            _ => options.bending * square,
        };
        Self {
            laplacian,
            power,
            stretching: options.stretching / square,
            bending,
        }
    }

    /// φ, of which A d is −L: K functions on the local vertices, right wherever a neighbour's row is full.
    pub fn potential<const K: usize>(&self, d: &[[f64; K]]) -> Vec<[f64; K]> {
        if self.power == 1 {
            return d.to_vec();
        }
        let mut phi = self.laplacian.per_area(d);
        if self.power == 3 {
            phi = self.laplacian.per_area(&phi);
        }
        let sign = if self.power == 2 { -self.bending } else { self.bending };
        phi.par_iter_mut().with_min_len(CHUNK).zip(d).for_each(|(phi, d)| {
            for k in 0..K {
                phi[k] *= sign;
                if self.stretching > 0.0 {
                    phi[k] += self.stretching * d[k];
                }
            }
        });
        phi
    }

    /// (A d)_i of `local`, given d's potential.
    #[inline]
    pub fn force<const K: usize>(&self, local: usize, potential: &[[f64; K]]) -> [f64; K] {
        let factor = if self.power == 1 {
            -(self.stretching + self.bending)
        } else {
            -1.0
        };
        self.laplacian.row(local, potential).map(|value| factor * value)
    }

    /// ½ dᵀ A d over K functions, summed from squares of differences, so that large common motions cost no digits.
    pub fn energy<const K: usize>(&self, d: &[[f64; K]]) -> f64 {
        let stretch = |f: &[[f64; K]]| sum_of_rows(f.len(), |local| self.edges(local, f));
        let bend = match self.power {
            1 => stretch(d),
            2 => sum_of_rows(d.len(), |local| {
                let row = self.laplacian.row(local, d);
                self.laplacian.inverse_areas()[local] * row.iter().map(|value| value * value).sum::<f64>()
            }),
            _ => stretch(&self.laplacian.per_area(d)),
        };
        let stretched = if self.stretching > 0.0 {
            self.stretching * stretch(d)
        } else {
            0.0
        };
        0.5 * (stretched + self.bending * bend)
    }

    /// This vertex' share of −fᵀ L f: half of each edge's, and all of it where the other end's row is not full.
    fn edges<const K: usize>(&self, local: usize, f: &[[f64; K]]) -> f64 {
        let ends = self
            .laplacian
            .neighbours(local)
            .iter()
            .zip(self.laplacian.weights(local));
        ends.map(|(&other, weight)| {
            let share = if self.laplacian.is_full(other as usize) {
                0.5
            } else {
                1.0
            };
            let square: f64 = (0..K).map(|k| (f[other as usize][k] - f[local][k]).powi(2)).sum();
            share * weight * square
        })
        .sum()
    }
}

/// Summed in chunks of a fixed size, so that the number of threads doesn't show.
fn sum_of_rows(count: usize, row: impl Fn(usize) -> f64 + Sync) -> f64 {
    let partial: Vec<f64> = (0..count.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| (chunk * CHUNK..((chunk + 1) * CHUNK).min(count)).map(&row).sum())
        .collect();
    partial.iter().sum()
}
