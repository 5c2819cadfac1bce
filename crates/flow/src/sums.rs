//! Sums over the vertices or triangles of each component, the same for any number of threads.

use rayon::prelude::*;

/// The entries of one task: fixed, so that results don't depend on the number of threads.
pub(crate) const CHUNK: usize = 1024;

/// The sum of `of` over all numbers below `count` in each component.
pub(crate) fn sums<const K: usize>(
    count: usize,
    component_count: usize,
    component: impl Fn(usize) -> usize,
    of: impl Fn(usize) -> [f64; K] + Sync,
) -> Vec<[f64; K]> {
    if component_count == 1 {
        return vec![sum(count, of)];
    }
    let mut sums = vec![[0.0; K]; component_count];
    for number in 0..count {
        add(&mut sums[component(number)], of(number));
    }
    sums
}

/// The sum of `of` over all numbers below `count`.
pub(crate) fn sum<const K: usize>(count: usize, of: impl Fn(usize) -> [f64; K] + Sync) -> [f64; K] {
    let chunk = |chunk: usize| {
        let mut sum = [0.0; K];
        for number in chunk * CHUNK..((chunk + 1) * CHUNK).min(count) {
            add(&mut sum, of(number));
        }
        sum
    };
    let partial: Vec<[f64; K]> = (0..count.div_ceil(CHUNK)).into_par_iter().map(chunk).collect();
    let mut total = [0.0; K];
    partial.into_iter().for_each(|sum| add(&mut total, sum));
    total
}

fn add<const K: usize>(sum: &mut [f64; K], terms: [f64; K]) {
    for (sum, term) in sum.iter_mut().zip(terms) {
        *sum += term;
    }
}
