//! Adds points inside a patch until it is as dense as the surrounding surface [Lie03, section 3].
//!
//! Each point has a *scale*, the mean length of its edges. A triangle is cut at its middle if the middle is further
//! from each corner than the scales of middle and corner, both divided by √2. New points take the mean scale of their
//! triangle, so density varies from one side of the rim to the other.

use std::f64::consts::SQRT_2;

use glam::DVec3;

use super::flips::flip_until_delaunay;
use super::patch::Patch;

/// The rounds of cutting, flipping and evening: each at most halves the edges.
const MOST_ROUNDS: usize = 40;

/// The rounds in which the points inside move to the middle of their neighbours.
const EVENING_ROUNDS: usize = 4;

/// The most points of a patch, as a share of its rim's squared count. A disc of equilateral triangles whose rim has n
/// edges has 0.09 n² points, a domed patch some more; a rim with a few needle edges would ask for any number.
const MOST_POINTS: f64 = 0.5;

/// Cuts triangles until none is too large. `scales` has one entry for each point, and gets those of the new points.
pub(crate) fn refine(patch: &mut Patch, scales: &mut Vec<f64>) {
    let most_points = patch.rim + (MOST_POINTS * (patch.rim as f64).powi(2)) as usize;
    flip_until_delaunay(patch);
    for _ in 0..MOST_ROUNDS {
        let mut is_done = true;
        for triangle in 0..patch.triangles.len() {
            let corners = patch.triangles[triangle];
            let points = patch.corners(triangle);
            let middle = points.into_iter().sum::<DVec3>() / 3.0;
            let scale = corners.iter().map(|&corner| scales[corner as usize]).sum::<f64>() / 3.0;
            let is_far = |(corner, point): (&u32, &DVec3)| {
                let far = SQRT_2 * middle.distance(*point);
                far > scale && far > scales[*corner as usize]
            };
            if patch.points.len() < most_points && corners.iter().zip(&points).all(is_far) {
                patch.split(triangle, middle);
                scales.push(scale);
                is_done = false;
            }
        }
        if is_done {
            return;
        }
        flip_until_delaunay(patch);
        even(patch);
    }
}

/// Moves the points inside along the patch towards the middle of their neighbours.
fn even(patch: &mut Patch) {
    for _ in 0..EVENING_ROUNDS {
        let neighbours = patch.neighbours();
        let normals = normals(patch);
        let moved: Vec<DVec3> = (patch.rim..patch.points.len())
            .map(|point| {
                let own = &neighbours[point];
                let middle = own.iter().map(|&other| patch.points[other as usize]).sum::<DVec3>() / own.len() as f64;
                let way = middle - patch.points[point];
                patch.points[point] + (way - normals[point] * way.dot(normals[point]))
            })
            .collect();
        patch.points[patch.rim..].copy_from_slice(&moved);
        flip_until_delaunay(patch);
    }
}

/// The unit normal at each point, by area.
fn normals(patch: &Patch) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; patch.points.len()];
    for triangle in 0..patch.triangles.len() {
        let [a, b, c] = patch.corners(triangle);
        let normal = (b - a).cross(c - a);
        for corner in patch.triangles[triangle] {
            normals[corner as usize] += normal;
        }
    }
    normals.iter().map(|normal| normal.normalize_or_zero()).collect()
}
