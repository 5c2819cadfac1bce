//! The front of a search: a priority queue of the vertices reached, by rising distance.
//!
//! Only the nearest vertices are kept in order. The others wait in bins by distance, so that the ordered part stays as
//! small as a bin and within the processor's caches, even if the front is wide.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::SurfaceVertex;

/// Bins for the whole distance.
const BINS: usize = 256;

/// Vertices and their distances, not negative, by rising distance and then by vertex.
#[derive(Clone, Debug, Default)]
pub(crate) struct Front {
    /// The entries of the bins up to `bin`, with distances as their bits, whose order is the same for numbers that are
    /// not negative.
    near: BinaryHeap<Reverse<(u64, SurfaceVertex)>>,
    far: Vec<Vec<Reverse<(u64, SurfaceVertex)>>>,
    bin: usize,
    bins_per_length: f64,
}

impl Front {
    /// Empties it, for distances up to `limit`; an infinite one has no bins.
    pub(crate) fn begin(&mut self, limit: f64) {
        self.near.clear();
        self.far.resize(BINS, Vec::new());
        self.far.iter_mut().for_each(Vec::clear);
        self.bin = 0;
        let bins_per_length = BINS as f64 / limit;
        self.bins_per_length = if bins_per_length.is_finite() {
            bins_per_length
        } else {
            0.0
        };
    }

    pub(crate) fn push(&mut self, distance: f64, v: SurfaceVertex) {
        let entry = Reverse((distance.to_bits(), v));
        let bin = ((distance * self.bins_per_length) as usize).min(BINS - 1);
        if bin <= self.bin {
            self.near.push(entry);
        } else {
            self.far[bin].push(entry);
        }
    }

    pub(crate) fn pop(&mut self) -> Option<(f64, SurfaceVertex)> {
        while self.near.is_empty() && self.bin + 1 < self.far.len() {
            self.bin += 1;
            self.near.extend(self.far[self.bin].drain(..));
        }
        self.near.pop().map(|Reverse((bits, v))| (f64::from_bits(bits), v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_in_comes_out_in_order_whatever_comes_between() {
        for limit in [0.0, 0.3, 2.0, f64::INFINITY] {
            let mut front = Front::default();
            front.begin(limit);
            let (mut number, mut last, mut count) = (7_u32, (0.0, SurfaceVertex(0)), 0);
            front.push(0.0, SurfaceVertex(0));
            while let Some(next) = front.pop() {
                assert!(next >= last, "{next:?} after {last:?}");
                last = next;
                count += 1;
                for _ in 0..2 {
                    number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    let farther = next.0 + f64::from(number >> 8) * 1e-9;
                    if farther <= 0.7 && count < 20_000 {
                        front.push(farther, SurfaceVertex(number));
                    }
                }
            }
            assert!(count > 1000, "{count}");
        }
    }
}
