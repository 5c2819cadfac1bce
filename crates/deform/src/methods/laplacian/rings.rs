//! Each vertex' neighbours within some edges.

use rayon::prelude::*;

use crate::Laplacian;
use crate::numerical::rows::CHUNK;

/// The rings of the vertices with full rows, in local vertices; empty if they are the Laplacian's own.
#[derive(Debug, Default)]
pub(super) struct Rings {
    offsets: Vec<u32>,
    others: Vec<u32>,
}

impl Rings {
    /// Within `size` edges.
    pub fn of(laplacian: &Laplacian, size: u32) -> Self {
        if size == 1 {
            return Self::default();
        }
        let count = laplacian.vertices().len();
        let chunks: Vec<(Vec<u32>, Vec<u32>)> = (0..count.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let (mut counts, mut others) = (Vec::new(), Vec::new());
                for local in chunk * CHUNK..((chunk + 1) * CHUNK).min(count) {
                    let before = others.len();
                    if laplacian.is_full(local) {
                        append_ring(laplacian, local as u32, size, &mut others);
                    }
                    counts.push((others.len() - before) as u32);
                }
                (counts, others)
            })
            .collect();
        let mut rings = Self {
            offsets: vec![0],
            others: Vec::new(),
        };
        let mut end = 0;
        for (counts, others) in chunks {
            for count in counts {
                end += count;
                rings.offsets.push(end);
            }
            rings.others.extend(others);
        }
        rings
    }

    /// The neighbours of a local vertex.
    #[inline]
    pub fn around<'a>(&'a self, laplacian: &'a Laplacian, local: usize) -> &'a [u32] {
        match self.offsets.get(local..local + 2) {
            Some(ends) => &self.others[ends[0] as usize..ends[1] as usize],
            None => laplacian.neighbours(local),
        }
    }

    /// Returns true if the rings have only the nearest neighbours.
    pub fn are_nearest(&self) -> bool {
        self.offsets.is_empty()
    }
}

/// A ring beyond the nearest neighbours ends at this many vertices: beside hubs it would be a large part of the
/// surface.
const LARGEST: usize = 256;

fn append_ring(laplacian: &Laplacian, local: u32, size: u32, others: &mut Vec<u32>) {
    let first = others.len();
    others.extend(laplacian.neighbours(local as usize));
    let mut begin = first;
    for _ in 1..size {
        let end = others.len();
        for place in begin..end {
            let beside = others[place] as usize;
            for &next in laplacian.neighbours(beside) {
                if others.len() - first >= LARGEST {
                    return;
                }
                if next != local && !others[first..].contains(&next) {
                    others.push(next);
                }
            }
        }
        begin = end;
    }
}
