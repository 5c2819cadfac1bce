//! The first shape for new weights of examples. It does not shrink where parts turn.
//!
//! In each example the turn R_k of each vertex is known: the rotation that fits its edges best. An edge e of the rest
//! shape, or a linear angle, becomes R (e + Σ_k w_k (R_kᵀ e_k − e)), with R the blended turn exp(Σ_k w_k log R_k) and
//! e_k the example's own edge: turns are blended along arcs, and strains in the vertex' own frame. The positions that
//! fit these best follow from one solution with the unfolded energy's factor (`carry`). With one weight 1 and the
//! others 0 they are the example itself.
//!
//! A turn's logarithm is the one nearest to the neighbour's, so that turns may exceed half a turn.

use std::f64::consts::TAU;

use glam::{DMat3, DQuat, DVec3};
use rayon::prelude::*;

use super::elements::Elements;
use super::shape::Energy;
use crate::numerical::rotation::fit_exactly;
use crate::numerical::rows::CHUNK;

/// A rotation by less than this, in radians, has no axis.
const NO_TURN: f64 = 1e-6;

/// The turns of the local vertices in each example.
#[derive(Debug, Default)]
pub(super) struct Turns {
    /// Rotation vectors: one row for each local vertex, one entry for each example.
    vectors: Vec<DVec3>,
}

impl Turns {
    /// Fits the turns of all examples.
    pub fn of(energy: &Energy) -> Self {
        let displacements = &energy.examples.displacements;
        let rest = &energy.elements.rest;
        let mut vectors = vec![DVec3::ZERO; rest.len() * displacements.len()];
        for (example, own) in displacements.iter().enumerate() {
            let places: Vec<DVec3> = rest.iter().zip(own).map(|(rest, moved)| *rest + *moved).collect();
            let turns = fitted(&energy.elements, rest, &places);
            for (vertex, vector) in continuous(&energy.elements, &turns).into_iter().enumerate() {
                vectors[vertex * displacements.len() + example] = vector;
            }
        }
        Self { vectors }
    }

    /// The blended turn of each local vertex.
    pub fn blended(&self, weights: &[f64]) -> Vec<DQuat> {
        let rows = self.vectors.par_chunks_exact(weights.len()).with_min_len(CHUNK);
        rows.map(|own| DQuat::from_scaled_axis(own.iter().zip(weights).map(|(own, weight)| *own * *weight).sum()))
            .collect()
    }

    /// The rotations from each example back to rest, one row for each local vertex.
    pub fn back(&self) -> Vec<DQuat> {
        let vectors = self.vectors.par_iter().with_min_len(CHUNK);
        vectors.map(|own| DQuat::from_scaled_axis(-*own)).collect()
    }
}

/// Fits rotations to the edges around each local vertex.
pub(super) fn fitted(elements: &Elements, from: &[DVec3], to: &[DVec3]) -> Vec<DQuat> {
    let mut sums = vec![DMat3::ZERO; elements.rest.len()];
    for edge in &elements.edges {
        let [a, b] = edge.ends.map(|end| end as usize);
        let (to, from) = (to[b] - to[a], from[b] - from[a]);
        let product = DMat3::from_cols(to * from.x, to * from.y, to * from.z) * edge.weight;
        sums[a] += product;
        sums[b] += product;
    }
    let each = sums.par_iter().with_min_len(CHUNK);
    each.map(|sum| fit_exactly(sum, DQuat::IDENTITY)).collect()
}

/// Makes rotation vectors differ little between neighbours: breadth first in each part, from its vertex with the least
/// turn.
fn continuous(elements: &Elements, turns: &[DQuat]) -> Vec<DVec3> {
    let mut vectors: Vec<DVec3> = turns.iter().map(|turn| turn.to_scaled_axis()).collect();
    let count = vectors.len();
    let mut offsets = vec![0_u32; count + 1];
    for end in elements.edges.iter().flat_map(|edge| edge.ends) {
        offsets[end as usize + 1] += 1;
    }
    for vertex in 0..count {
        offsets[vertex + 1] += offsets[vertex];
    }
    let mut next = offsets.clone();
    let mut others = vec![0; offsets[count] as usize];
    for [a, b] in elements.edges.iter().map(|edge| edge.ends) {
        for (from, to) in [(a, b), (b, a)] {
            others[next[from as usize] as usize] = to;
            next[from as usize] += 1;
        }
    }
    let mut seeds: Vec<u32> = (0..count as u32).collect();
    let angle = |vertex: u32| vectors[vertex as usize].length();
    seeds.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)).then(a.cmp(&b)));
    let mut is_reached = vec![false; count];
    let mut queue = Vec::new();
    for seed in seeds {
        if std::mem::replace(&mut is_reached[seed as usize], true) {
            continue;
        }
        queue.clear();
        queue.push(seed);
        let mut head = 0;
        while let Some(&vertex) = queue.get(head) {
            head += 1;
            let near = vectors[vertex as usize];
            let row = offsets[vertex as usize] as usize..offsets[vertex as usize + 1] as usize;
            for &other in &others[row] {
                if !std::mem::replace(&mut is_reached[other as usize], true) {
                    let own = &mut vectors[other as usize];
                    *own = nearest(*own, near);
                    queue.push(other);
                }
            }
        }
    }
    vectors
}

/// Returns the rotation vector nearest to `near` among those of the same rotation.
fn nearest(vector: DVec3, near: DVec3) -> DVec3 {
    let angle = vector.length();
    let axis = match angle > NO_TURN {
        true => vector / angle,
        false => near.normalize_or_zero(),
    };
    vector + axis * (TAU * ((axis.dot(near) - angle) / TAU).round())
}

#[cfg(test)]
mod tests {
    use super::nearest;
    use glam::DVec3;

    #[test]
    fn a_turn_goes_on_beyond_half_a_turn() {
        let axis = DVec3::new(0.6, 0.0, 0.8);
        let mut last = DVec3::ZERO;
        for step in 0..80 {
            let expected = axis * (0.1 * f64::from(step));
            let turn = glam::DQuat::from_scaled_axis(expected).to_scaled_axis();
            last = nearest(turn, last);
            assert!((last - expected).length() < 1e-9, "{expected}: {last}");
        }
    }
}
