//! Sums over long vectors, in parallel and yet the same bit for bit on any number of threads: fixed chunks, their
//! partial sums added up in order.

use rayon::prelude::*;

use crate::numerical::rows::CHUNK;

/// A vector field, one vector per column of the factor.
pub(crate) type Field = Vec<[f64; 3]>;

/// The fewest chunks of a task: for shorter fields, waking a thread costs more than it saves.
pub(crate) const CHUNKS_A_TASK: usize = 8;

/// a · b.
pub(crate) fn dot(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let partial: Vec<f64> = a
        .par_chunks(CHUNK)
        .zip(b.par_chunks(CHUNK))
        .with_min_len(CHUNKS_A_TASK)
        .map(|(a, b)| {
            let mut sums = [0.0; 3];
            for (a, b) in a.iter().zip(b) {
                for k in 0..3 {
                    sums[k] += a[k] * b[k];
                }
            }
            sums.iter().sum()
        })
        .collect();
    partial.iter().sum()
}

/// a ← a + factor b.
pub(crate) fn add(a: &mut [[f64; 3]], factor: f64, b: &[[f64; 3]]) {
    a.par_chunks_mut(CHUNK)
        .zip(b.par_chunks(CHUNK))
        .with_min_len(CHUNKS_A_TASK)
        .for_each(|(a, b)| {
            for (a, b) in a.iter_mut().zip(b) {
                for k in 0..3 {
                    a[k] += factor * b[k];
                }
            }
        });
}
