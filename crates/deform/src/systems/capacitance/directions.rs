//! Directions that are conjugate with respect to a matrix S, and solving with them.
//!
//! They are few and short, so each new one is made conjugate to all before it, whereas conjugate gradients are
//! conjugate only in exact arithmetic. All right-hand sides contribute to the same directions and profit from all of
//! them (block conjugate gradients [OLe80]).

use rayon::prelude::*;

use crate::numerical::rows::CHUNK;

/// vᵢᵀ S vⱼ = δᵢⱼ.
#[derive(Debug, Default)]
pub(super) struct Directions {
    own: Vec<Vec<f64>>,
    /// S v of each.
    images: Vec<Vec<f64>>,
}

/// A new direction keeps at least this share of its squared S-norm when the others of its block are removed; less is
/// rounding.
const INDEPENDENT: f64 = 1e-12;

impl Directions {
    /// The number of directions.
    pub fn len(&self) -> usize {
        self.own.len()
    }

    /// Adds further directions, each with its image.
    pub fn extend(&mut self, others: impl IntoIterator<Item = (Vec<f64>, Vec<f64>)>) {
        for (own, image) in others {
            self.own.push(own);
            self.images.push(image);
        }
    }

    /// The first directions, this many.
    pub fn first(self, count: usize) -> impl Iterator<Item = (Vec<f64>, Vec<f64>)> {
        self.own.into_iter().zip(self.images).take(count)
    }

    /// Solves S y = r in the span of the directions from number `first` on, adds to `y` and subtracts from `r`.
    pub fn project<const K: usize>(&self, first: usize, y: &mut [[f64; K]], r: &mut [[f64; K]]) {
        let (own, images) = (&self.own[first..], &self.images[first..]);
        let shares = products(own, r);
        subtract(
            y,
            own,
            &shares.iter().map(|share| share.map(|value| -value)).collect::<Vec<_>>(),
        );
        subtract(r, images, &shares);
    }

    /// Makes a block conjugate to these directions.
    pub fn remove_from<const K: usize>(&self, block: &mut [[f64; K]]) {
        let shares = products(&self.images, block);
        subtract(block, &self.own, &shares);
    }
}

/// The S-orthonormal directions that span a block whose images under S are given; dependent ones are left out.
pub(super) fn orthonormalised<const K: usize>(block: &[[f64; K]], images: &[[f64; K]]) -> Vec<(Vec<f64>, Vec<f64>)> {
    let mut found: Vec<(Vec<f64>, Vec<f64>)> = Vec::with_capacity(K);
    for k in 0..K {
        let mut own: Vec<f64> = block.iter().map(|row| row[k]).collect();
        let mut image: Vec<f64> = images.iter().map(|row| row[k]).collect();
        let whole = dot(&own, &image);
        for _ in 0..2 {
            for (other, other_image) in &found {
                let share = dot(other_image, &own);
                for (own, other) in own.iter_mut().zip(other) {
                    *own -= share * other;
                }
                for (image, other) in image.iter_mut().zip(other_image) {
                    *image -= share * other;
                }
            }
        }
        let left = dot(&own, &image);
        if left.is_finite() && left > INDEPENDENT * whole {
            let factor = left.sqrt().recip();
            own.iter_mut().chain(&mut image).for_each(|value| *value *= factor);
            found.push((own, image));
        }
    }
    found
}

/// The Euclidean norm of each column.
pub(super) fn norms<const K: usize>(block: &[[f64; K]]) -> [f64; K] {
    let mut sums = [0.0; K];
    for row in block {
        for k in 0..K {
            sums[k] += row[k] * row[k];
        }
    }
    sums.map(f64::sqrt)
}

/// Each vector's product with each column; every sum runs in order on one thread.
fn products<const K: usize>(vectors: &[Vec<f64>], block: &[[f64; K]]) -> Vec<[f64; K]> {
    let product = |vector: &Vec<f64>| {
        let mut sums = [0.0; K];
        for (value, row) in vector.iter().zip(block) {
            for k in 0..K {
                sums[k] += value * row[k];
            }
        }
        sums
    };
    vectors.par_iter().map(product).collect()
}

/// block ← block − vectors · shares.
fn subtract<const K: usize>(block: &mut [[f64; K]], vectors: &[Vec<f64>], shares: &[[f64; K]]) {
    block.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, rows)| {
        let first = chunk * CHUNK;
        for (vector, share) in vectors.iter().zip(shares) {
            for (row, value) in rows.iter_mut().zip(&vector[first..]) {
                for k in 0..K {
                    row[k] -= value * share[k];
                }
            }
        }
    });
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
