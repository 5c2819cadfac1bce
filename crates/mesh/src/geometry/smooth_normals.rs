//! Some vertices of a surface, and its normals at a scale there.
//!
//! Scans bend at every size, down to their noise, so the normals are smoothed: (1 − σ² Δ) N = n, with n the normals of the
//! vertices and Δ the mean of the neighbours less the vertex, over a quarter of its mean squared edge. Chebyshev's
//! semi-iteration [GV61] solves this in some σ/h rounds, h an edge's length, where repeated averages would take (σ/h)².

use glam::DVec3;
use rayon::prelude::*;

use crate::{SurfaceVertex, Topology};

/// Rounds of the iteration over the square root of the largest weight of the neighbours. The error falls to less than a
/// hundredth, 1/cosh(4 √2): what is left of it alternates in sign, so it would show as creases beside each edge.
const ROUNDS: f64 = 4.0;

/// The largest weight of the neighbours, which bounds the rounds to 80: a scale is at most ten edges long.
const MOST_WEIGHT: f64 = 400.0;

/// Vertices that one thread takes at a time, at least.
const PIECE: usize = 1 << 12;

/// Some vertices of a surface, each once, with their places among each other.
pub(crate) struct SomeVertices<'a> {
    topology: &'a Topology,
    positions: &'a [DVec3],
    vertices: &'a [SurfaceVertex],
    /// The place of each of the surface's vertices; `u32::MAX` for others.
    places: Vec<u32>,
}

impl<'a> SomeVertices<'a> {
    pub(crate) fn of(topology: &'a Topology, positions: &'a [DVec3], vertices: &'a [SurfaceVertex]) -> Self {
        let mut places = vec![u32::MAX; positions.len()];
        for (place, v) in (0..).zip(vertices) {
            places[v.index()] = place;
        }
        Self {
            topology,
            positions,
            vertices,
            places,
        }
    }

    /// The place of a vertex; `None` for one of the others.
    pub(crate) fn place(&self, v: SurfaceVertex) -> Option<u32> {
        Some(self.places[v.index()]).filter(|&place| place != u32::MAX)
    }

    pub(crate) fn position(&self, place: usize) -> DVec3 {
        self.positions[self.vertices[place].index()]
    }

    /// The places of the neighbours among these vertices.
    pub(crate) fn neighbours(&self, place: usize) -> impl Iterator<Item = usize> + '_ {
        let all = self.topology.neighbours(self.vertices[place]).iter();
        all.filter_map(|&v| self.place(v)).map(|place| place as usize)
    }

    /// A value for each of the vertices, by its place.
    pub(crate) fn each<T: Send>(&self, of: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        let all = (0..self.vertices.len()).into_par_iter();
        all.with_min_len(PIECE).map(of).collect()
    }

    /// The unit normals, smoothed over the length `scale`. Only these vertices and the triangles around them count.
    pub(crate) fn normals(&self, triangles: &[[SurfaceVertex; 3]], scale: f64) -> Vec<DVec3> {
        let normal = |place: usize| {
            let faces = self.topology.faces(self.vertices[place], triangles);
            let corners = faces.map(|face| triangles[face as usize].map(|v| self.positions[v.index()]));
            corners
                .map(|[a, b, c]| (b - a).cross(c - a))
                .sum::<DVec3>()
                .normalize_or_zero()
        };
        let weight = |place: usize| {
            let here = self.position(place);
            let squares = self
                .neighbours(place)
                .map(|other| here.distance_squared(self.position(other)));
            let (sum, count) = squares.fold((0.0, 0.0), |(sum, count), square| (sum + square, count + 1.0));
            // Without neighbours, or at one point with them, nothing is smoothed.
            let weight = 4.0 * scale * scale * count / sum;
            if weight.is_finite() {
                weight.min(MOST_WEIGHT)
            } else {
                0.0
            }
        };
        self.smoothed(&self.each(normal), &self.each(weight))
    }

    /// The unit normals N with (1 + w) N − w mean(N) = n, nearly: w are the weights, n the normals, and the mean is the
    /// neighbours'.
    fn smoothed(&self, normals: &[DVec3], weights: &[f64]) -> Vec<DVec3> {
        let most = weights.iter().copied().fold(0.0, f64::max);
        // The largest factor by which an average shrinks an error.
        let shrinks = most / (1.0 + most);
        let mean = |present: &[DVec3], place: usize| {
            let sum: DVec3 = self.neighbours(place).map(|other| present[other]).sum();
            sum / (self.neighbours(place).count().max(1)) as f64
        };
        let (mut before, mut present) = (normals.to_vec(), normals.to_vec());
        let mut ahead = 1.0;
        for round in 0..(ROUNDS * most.sqrt()).ceil() as usize {
            let next = self.each(|place| {
                let share = weights[place] / (1.0 + weights[place]);
                let averaged = normals[place].lerp(mean(&present, place), share);
                before[place] + (averaged - before[place]) * ahead
            });
            (before, present) = (present, next);
            ahead = match round {
                0 => 1.0 / (1.0 - 0.5 * shrinks * shrinks),
                _ => 1.0 / (1.0 - 0.25 * shrinks * shrinks * ahead),
            };
        }
        present
            .par_iter_mut()
            .with_min_len(PIECE)
            .for_each(|normal| *normal = normal.normalize_or_zero());
        present
    }
}
