//! The detail of each vertex as a function of its strain [BLB+08, section 4].
//!
//! Bickel et al. interpolate by the biharmonic function φ(r) = r. Here a constant is added, with weights that sum to 0,
//! and rest is one of the centres, without detail. The weight of rest is then eliminated, which leaves, over the
//! examples j with the strains f_j,
//!
//! d(f) = Σ_j w_j K(f, f_j),   K(f, g) = ½ (|f| + |g| − |f − g|).
//!
//! K is positive definite, because distances are of negative type [Sch38]. With one example d grows in proportion up to
//! the example's own strain and stays there beyond, and a strain of the opposite sign, if the skin is stretched instead
//! of compressed, makes no wrinkle. Without the constant it would make the same wrinkle.

use faer::Mat;
use glam::DVec3;
use rayon::prelude::*;

use super::strain::Strain;
use crate::numerical::dense::solved;
use crate::numerical::rows::CHUNK;

/// The examples' details, and the functions that interpolate them. Tables of rows have one entry per example in each
/// row.
#[derive(Debug)]
pub(super) struct Learnt {
    examples: usize,
    /// The strain of each edge in each example.
    strains: Vec<f64>,
    /// |f_j| of each row.
    lengths: Vec<f64>,
    /// The example's detail of each row, in the coarse shape's frame.
    details: Vec<DVec3>,
    /// w_j of each row.
    coefficients: Vec<DVec3>,
}

/// The strain below which a vertex learns little: strain is not the reason for a detail there.
const THRESHOLD: f64 = 1e-4;

/// Strains that differ by less than about this count as equal.
const RESOLUTION: f64 = 1e-8;

/// An example whose details are all smaller than this share of the diagonal has none.
const SMALLEST: f64 = 1e-4;

impl Learnt {
    /// Bytes of a row for each example.
    pub const ROW: usize = size_of::<f64>() + 2 * size_of::<DVec3>();

    /// The table for this many examples without detail.
    pub fn new(examples: usize, rows: usize, strain: &Strain) -> Self {
        Self {
            examples,
            strains: vec![0.0; strain.len() * examples],
            lengths: vec![0.0; rows * examples],
            details: vec![DVec3::ZERO; rows * examples],
            coefficients: vec![DVec3::ZERO; rows * examples],
        }
    }

    /// Enters an example: the strain of its coarse shape at each edge, and its details.
    pub fn add(&mut self, example: usize, strain: &Strain, changes: &[f64], details: Vec<DVec3>) {
        for (edge, change) in changes.iter().enumerate() {
            self.strains[edge * self.examples + example] = *change;
        }
        for (row, detail) in details.into_iter().enumerate() {
            let place = row * self.examples + example;
            self.lengths[place] = strain.distance(row, |edge| changes[edge]);
            self.details[place] = detail;
        }
    }

    /// For each example, true if the strain restores at least half of its visible details.
    pub fn are_learnt(&self, diagonal: f64) -> Vec<bool> {
        let of = |example: usize| {
            let places = (example..self.details.len()).step_by(self.examples);
            let (mut all, mut learnt, mut largest) = (0.0, 0.0, 0.0_f64);
            for place in places {
                let length = self.details[place].length();
                all += length * length;
                learnt += (share(self.lengths[place]) * length).powi(2);
                largest = largest.max(length);
            }
            learnt >= 0.25 * all || largest < SMALLEST * diagonal
        };
        (0..self.examples).map(of).collect()
    }

    /// Solves for the w_j that give each example's detail, times its weight, at its own strain.
    pub fn weigh(&mut self, weights: &[f64], strain: &Strain) {
        let count = self.examples;
        let mut coefficients = std::mem::take(&mut self.coefficients);
        let own = &*self;
        coefficients
            .par_chunks_mut(CHUNK * count)
            .enumerate()
            .for_each(|(chunk, out)| {
                for (row, out) in out.chunks_mut(count).enumerate() {
                    let row = chunk * CHUNK + row;
                    let kernel = |j: usize, k: usize| {
                        let ridge = if j == k { RESOLUTION } else { 0.0 };
                        own.kernel(row, strain, own.lengths[row * count + j], k, |edge| {
                            own.strains[edge * count + j]
                        }) + ridge
                    };
                    let value = |k: usize| {
                        let place = row * count + k;
                        own.details[place] * (weights[k] * share(own.lengths[place]))
                    };
                    let solution = solved(
                        Mat::from_fn(count, count, kernel),
                        Mat::from_fn(count, 3, |k, axis| value(k)[axis]),
                    );
                    for (k, coefficient) in out.iter_mut().enumerate() {
                        *coefficient = DVec3::from_array(std::array::from_fn(|axis| solution[(k, axis)]));
                    }
                }
            });
        self.coefficients = coefficients;
    }

    /// d of a row: zero to the last bit if the `changes` of the edges' lengths are.
    #[inline]
    pub fn detail(&self, row: usize, strain: &Strain, changes: &[f64]) -> DVec3 {
        let own = &self.coefficients[row * self.examples..][..self.examples];
        let length = strain.distance(row, |edge| changes[edge]);
        let mut detail = DVec3::ZERO;
        for (k, coefficient) in own.iter().enumerate() {
            if *coefficient != DVec3::ZERO {
                detail += *coefficient * self.kernel(row, strain, length, k, |edge| changes[edge]);
            }
        }
        detail
    }

    /// K(f, f_k) at a row, |f| being `length`.
    #[inline]
    fn kernel(&self, row: usize, strain: &Strain, length: f64, k: usize, f: impl Fn(usize) -> f64) -> f64 {
        let apart = strain.distance(row, |edge| f(edge) - self.strains[edge * self.examples + k]);
        0.5 * (length + self.lengths[row * self.examples + k] - apart)
    }
}

/// The share of an example's detail that a vertex learns at this strain.
fn share(strain: f64) -> f64 {
    1.0 / (1.0 + (THRESHOLD / strain).powi(4))
}
