//! A few points that represent many.

use std::collections::HashSet;

use glam::DVec3;
use rayon::prelude::*;

/// At most about this many of the vertices: the first in each cell of the finest grid without more occupied cells.
pub(crate) fn thinned(vertices: &[u32], positions: &[DVec3], most: usize) -> Vec<u32> {
    if vertices.len() <= most {
        return vertices.to_vec();
    }
    let points = || vertices.iter().map(|&vertex| positions[vertex as usize]);
    let (low, high) = points().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), point| {
        (low.min(point), high.max(point))
    });
    let extent = (high - low).max_element();
    // Each coarser grid has a quarter to an eighth of the cells.
    let mut cells = 1024.0;
    loop {
        let cell = |point: DVec3| ((point - low) * (cells / extent)).as_i64vec3();
        let mut seen = HashSet::new();
        let kept = |vertex: &&u32| seen.insert(cell(positions[**vertex as usize]));
        let kept: Vec<u32> = vertices.iter().filter(kept).copied().collect();
        if kept.len() <= most || cells <= 1.0 {
            return kept;
        }
        cells *= 0.5_f64.max((most as f64 / kept.len() as f64).sqrt());
    }
}

/// A point is farther than another only by more than this share: the first of equal ones is chosen, even if rounding
/// makes a difference.
pub(crate) const EQUAL: f64 = 1e-9;

/// At most this many of the vertices, each new one the farthest in space from earlier ones. The first is the farthest
/// from the mean; the first of equal ones is chosen.
pub(crate) fn farthest(vertices: &[u32], positions: &[DVec3], most: usize) -> Vec<u32> {
    if vertices.len() <= most {
        return vertices.to_vec();
    }
    let point = |place: usize| positions[vertices[place] as usize];
    let origin = point(0);
    let mean = origin + (0..vertices.len()).map(|place| point(place) - origin).sum::<DVec3>() / vertices.len() as f64;
    let mut distances: Vec<f64> = (0..vertices.len()).map(|place| point(place).distance(mean)).collect();
    let mut chosen = Vec::with_capacity(most);
    while chosen.len() < most {
        let farther = |best: usize, place: usize| {
            if distances[place] > distances[best] {
                place
            } else {
                best
            }
        };
        let best = (0..vertices.len()).fold(0, farther);
        if distances[best] == 0.0 {
            break;
        }
        let from = point(best);
        let is_first = chosen.is_empty();
        chosen.push(vertices[best]);
        distances
            .par_iter_mut()
            .enumerate()
            .with_min_len(4096)
            .for_each(|(place, distance)| {
                let to = point(place).distance(from);
                *distance = if is_first { to } else { distance.min(to) };
            });
    }
    chosen
}
