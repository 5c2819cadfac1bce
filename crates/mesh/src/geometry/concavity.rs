//! The concavity of a surface at a scale: how fast its smoothed normals turn towards each other.
//!
//! Parts of a shape end in concave creases, by the minima rule of human vision [HR84]. Scans have such creases at every
//! size, down to their noise, so the normals are smoothed first: (1 − σ² Δ) N = n, with n the normals of the vertices and
//! Δ the mean of the neighbours less the vertex, over a quarter of its mean squared edge. Chebyshev's semi-iteration
//! [GV61] solves this in some σ/h rounds, h an edge's length, where repeated averages would take (σ/h)². On a fine mesh it
//! is solved on clusters of vertices first, whose distances are still a fraction of σ.

use glam::DVec3;
use rayon::prelude::*;

use super::clusters::Neighbours;
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

/// The concavity of the surface at each of some vertices, in radians per world unit: the largest rate over its edges at
/// which the normals, smoothed over the length `scale`, turn towards each other; 0 where the surface is flat or convex.
/// Only these vertices, each listed once, and the triangles around them count.
pub fn concavities(
    triangles: &[[SurfaceVertex; 3]],
    topology: &Topology,
    positions: &[DVec3],
    vertices: &[SurfaceVertex],
    scale: f64,
) -> Vec<f64> {
    let normal = |vertex: &SurfaceVertex| {
        let faces = topology.faces(*vertex, triangles);
        let corners = faces.map(|face| triangles[face as usize].map(|v| positions[v.index()]));
        let areas = corners.map(|[a, b, c]| (b - a).cross(c - a));
        areas.sum::<DVec3>().normalize_or_zero()
    };
    let normals: Vec<DVec3> = vertices.par_iter().with_min_len(PIECE).map(normal).collect();
    let points: Vec<DVec3> = vertices.iter().map(|v| positions[v.index()]).collect();
    let neighbours = Neighbours::among(vertices, topology);
    let smooth = smoothed(&points, &normals, &neighbours, scale);
    let concavity = |place: usize| {
        let rate = |&other: &u32| {
            let edge = points[other as usize] - points[place];
            (smooth[place] - smooth[other as usize]).dot(edge) / edge.length_squared()
        };
        // `max` leaves out NaN, of edges without a length.
        neighbours.at(place).iter().map(rate).fold(0.0, f64::max)
    };
    of_each(&points).map(concavity).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Drawn, shapes};

    /// The total turn that a way along x over the whole of the surface crosses, and the largest concavity.
    fn turn(drawn: Drawn, scale: f64) -> (f64, f64) {
        let model = shapes::model(drawn);
        let vertices: Vec<SurfaceVertex> = (0..model.surface.positions.len() as u32).map(SurfaceVertex).collect();
        let (triangles, positions) = (&model.surface.triangles, &model.surface.positions);
        let found = concavities(triangles, &model.topology, positions, &vertices, scale);
        let most = found.iter().copied().fold(0.0, f64::max);
        let on_way = |p: &DVec3| (p.y - 0.5).abs() < 1e-9;
        let mut way: Vec<(DVec3, f64)> = model.surface.positions.iter().copied().zip(found).collect();
        way.retain(|(p, _)| on_way(p));
        way.sort_by(|(a, _), (b, _)| a.x.total_cmp(&b.x));
        let step = |pair: &[(DVec3, f64)]| 0.5 * (pair[0].1 + pair[1].1) * pair[0].0.distance(pair[1].0);
        (way.windows(2).map(step).sum(), most)
    }

    /// A sheet over the unit square that folds up by `angle` along x = 0.5.
    fn folded(cells: usize, angle: f64) -> Drawn {
        let mut drawn = shapes::grid(cells, cells);
        for p in &mut drawn.positions {
            let beyond = (p.x - 0.5).max(0.0);
            *p += DVec3::new(angle.cos() - 1.0, 0.0, angle.sin()) * beyond;
        }
        drawn
    }

    #[test]
    fn a_way_across_a_crease_turns_by_its_angle_on_every_mesh() {
        for cells in [40, 80, 160] {
            for angle in [0.3, 0.8, 1.2] {
                let (across, _) = turn(folded(cells, angle), 0.05);
                // Each vertex counts the edge on the side of the crease, and the one in it counts its edge once more: the
                // turn left at a distance x falls as exp(−x/σ).
                let twice = 0.5 * (1.0 - (-1.0 / (cells as f64 * 0.05)).exp());
                assert!(
                    (0.8..1.05 + twice).contains(&(across / angle)),
                    "{cells} cells, {angle}: {across}"
                );
                let (_, convex) = turn(folded(cells, -angle), 0.05);
                assert!(convex < 0.5 * angle, "{cells} cells, −{angle}: {convex}");
            }
        }
    }

    #[test]
    fn flat_and_round_shapes_have_none_and_noise_is_smoothed_away() {
        assert!(turn(shapes::grid(40, 40), 0.05).1 < 1e-9);
        assert!(turn(shapes::icosphere(4), 0.1).1 < 0.05);
        let mut rough = shapes::grid(120, 120);
        let mut number = 7_u32;
        for p in &mut rough.positions {
            number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            p.z += 1e-3 * (f64::from(number >> 8) / f64::from(1 << 24) - 0.5);
        }
        let (fine, coarse) = (turn(rough.clone(), 1e-3).0, turn(rough, 0.05).0);
        assert!(coarse < 0.1 * fine, "{fine} {coarse}");
    }
}
