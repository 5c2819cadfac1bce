//! Some vertices of a surface, and its normals at a scale there.
//!
//! Scans bend at every size, down to their noise, so the normals are smoothed: (1 − σ² Δ) N = n, with n the normals of the
//! vertices and Δ the mean of the neighbours less the vertex, over a quarter of its mean squared edge. Chebyshev's
//! semi-iteration [GV61] solves this in some σ/h rounds, h an edge's length, where repeated averages would take (σ/h)². On
//! a fine mesh it is solved on clusters of vertices first, whose distances are still a fraction of σ.

use glam::DVec3;
use rayon::prelude::*;

use super::clusters::{Neighbours, places_of};
use crate::{SurfaceVertex, Topology};

/// Rounds of the iteration over the square root of the largest weight of the neighbours. The error falls to less than a
/// hundredth, 1/cosh(4 √2): what is left of it alternates in sign, so it would show as creases beside each edge.
const ROUNDS: f64 = 4.0;

/// A scale of more edges than this, in the mean, begins with normals that are smoothed on clusters of vertices.
const MOST_EDGES: f64 = 4.0;

/// Averages that smooth the steps between clusters, which are some three edges wide.
const CLUSTER_ROUNDS: usize = 8;

/// The largest weight of the neighbours, which bounds the rounds to 80: where edges are short for their mesh, the scale is
/// at most ten of them.
const MOST_WEIGHT: f64 = 400.0;

/// Vertices that one thread takes at a time, at least.
const PIECE: usize = 1 << 12;

/// Some vertices of a surface, each once, with their places among each other.
pub(crate) struct SomeVertices<'a> {
    topology: &'a Topology,
    /// Those of all of the surface's vertices.
    positions: &'a [DVec3],
    vertices: &'a [SurfaceVertex],
    points: Vec<DVec3>,
    /// The place of each of the surface's vertices; `u32::MAX` for others.
    places: Vec<u32>,
    neighbours: Neighbours,
}

impl<'a> SomeVertices<'a> {
    pub(crate) fn of(topology: &'a Topology, positions: &'a [DVec3], vertices: &'a [SurfaceVertex]) -> Self {
        let places = places_of(vertices, positions.len());
        Self {
            topology,
            positions,
            vertices,
            points: vertices.iter().map(|v| positions[v.index()]).collect(),
            neighbours: Neighbours::among(vertices, topology, &places),
            places,
        }
    }

    /// The place of a vertex; `None` for one of the others.
    pub(crate) fn place(&self, v: SurfaceVertex) -> Option<u32> {
        Some(self.places[v.index()]).filter(|&place| place != u32::MAX)
    }

    pub(crate) fn position(&self, place: usize) -> DVec3 {
        self.points[place]
    }

    /// The places of the neighbours among these vertices.
    pub(crate) fn neighbours(&self, place: usize) -> impl Iterator<Item = usize> + '_ {
        self.neighbours.at(place).iter().map(|&place| place as usize)
    }

    /// A value for each of the vertices, by its place.
    pub(crate) fn each<T: Send>(&self, of: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        of_each(&self.points).map(of).collect()
    }

    /// The unit normals, smoothed over the length `scale`. Only these vertices and the triangles around them count.
    pub(crate) fn normals(&self, triangles: &[[SurfaceVertex; 3]], scale: f64) -> Vec<DVec3> {
        let normal = |place: usize| {
            let faces = self.topology.faces(self.vertices[place], triangles);
            let corners = faces.map(|face| triangles[face as usize].map(|v| self.positions[v.index()]));
            let areas = corners.map(|[a, b, c]| (b - a).cross(c - a));
            areas.sum::<DVec3>().normalize_or_zero()
        };
        smoothed(&self.points, &self.each(normal), &self.neighbours, scale)
    }
}

fn of_each(points: &[DVec3]) -> impl IndexedParallelIterator<Item = usize> {
    (0..points.len()).into_par_iter().with_min_len(PIECE)
}

/// The unit normals N with (1 + w) N − w `mean`(N) = n, nearly: n are the normals, and w the weights of the neighbours.
fn smoothed(points: &[DVec3], normals: &[DVec3], neighbours: &Neighbours, scale: f64) -> Vec<DVec3> {
    let weight = |place: usize| {
        let others = neighbours.at(place).iter();
        let squares = others.map(|&other| points[place].distance_squared(points[other as usize]));
        let (sum, count) = squares.fold((0.0, 0.0), |(sum, count), square| (sum + square, count + 1.0));
        // Without neighbours, or at one point with them, nothing is smoothed.
        let weight = 4.0 * scale * scale * count / sum;
        if weight.is_finite() {
            weight.min(MOST_WEIGHT)
        } else {
            0.0
        }
    };
    let weights: Vec<f64> = of_each(points).map(weight).collect();
    let most = weights.iter().copied().fold(0.0, f64::max);
    // The largest factor by which an average shrinks an error.
    let mut shrinks = most / (1.0 + most);
    let mut rounds = (ROUNDS * most.sqrt()).ceil() as usize;
    let mut present = normals.to_vec();
    if scale * scale > MOST_EDGES * MOST_EDGES * neighbours.mean_squared_edge(points) {
        let (clusters, coarse) = neighbours.clusters();
        let means = smoothed(&clusters.means(points), &clusters.means(normals), &coarse, scale);
        // Averages alone settle the steps between clusters.
        (present, rounds, shrinks) = (clusters.spread(&means), CLUSTER_ROUNDS, 0.0);
    }
    let mut before = present.clone();
    let mut ahead = 1.0;
    for round in 0..rounds {
        let places = before.par_iter_mut().with_min_len(PIECE).enumerate();
        // The next normal takes the place of the one before.
        places.for_each(|(place, normal)| {
            let share = weights[place] / (1.0 + weights[place]);
            let averaged = normals[place].lerp(neighbours.mean(&present, place), share);
            *normal += (averaged - *normal) * ahead;
        });
        std::mem::swap(&mut before, &mut present);
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
