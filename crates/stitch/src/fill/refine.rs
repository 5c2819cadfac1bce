//! Adds points inside a patch until it is as dense as the surrounding surface [Lie03, section 3].
//!
//! Each point has a *scale*, the mean length of the edges around, and a *spacing*, which is at least that. A triangle is
//! cut at its middle if the middle is further from each corner than the spacings of middle and corner, both divided by
//! √2. New points take the mean scale of their triangle, so density varies from one side of the rim to the other. Their
//! spacing grows from ring to ring inwards, up to that at which the patch has as many points as are wanted: so a patch
//! with a long rim can be coarse in its middle, and is as fine as the surface at its rim.

use std::f64::consts::SQRT_2;

use glam::DVec3;

use super::flips::flip_until_delaunay;
use super::patch::Patch;

/// The rounds of cutting, flipping and evening: each at most halves the edges.
const MOST_ROUNDS: usize = 40;

/// A round that adds less than this share of the points is the last.
const FEW: f64 = 0.002;

/// The rounds in which the points inside move to the middle of their neighbours.
const EVENING_ROUNDS: usize = 4;

/// The growth of the spacing from one ring to the next.
const GROWTH: f64 = 1.25;

/// The most points of a patch, as a share of its rim's squared count. A disc of equilateral triangles whose rim has n
/// edges has 0.09 n² points, a domed patch some more; a rim with a few needle edges would ask for any number.
const SHARE_OF_SQUARE: f64 = 0.5;

/// The lengths at a patch's points.
#[derive(Clone, Debug, Default)]
pub(crate) struct Density {
    /// The mean length of the edges around each point, on the surrounding surface.
    scales: Vec<f64>,
    /// The distance to the next point at which a triangle is small enough.
    spacings: Vec<f64>,
}

impl Density {
    /// That of a patch's first points, with these scales.
    pub fn of(scales: Vec<f64>) -> Self {
        let spacings = scales.clone();
        Self { scales, spacings }
    }
}

/// Cuts triangles until none is too large for a patch of about `most` points. Returns true if the patch is as dense as
/// the surface, and false if it is coarser in its middle.
pub(crate) fn refine(patch: &mut Patch, density: &mut Density, most: usize) -> bool {
    let of_rim = SHARE_OF_SQUARE * (patch.rim as f64).powi(2);
    let most = most.min(of_rim as usize);
    let largest = largest_spacing(patch, most);
    for (spacing, scale) in density.spacings.iter_mut().zip(&density.scales) {
        *spacing = scale.max(spacing.min(largest));
    }
    flip_until_delaunay(patch);
    for _ in 0..MOST_ROUNDS {
        let before = patch.points.len();
        for triangle in 0..patch.triangles.len() {
            let corners = patch.triangles[triangle];
            let points = patch.corners(triangle);
            let middle = points.into_iter().sum::<DVec3>() / 3.0;
            let mean = |list: &[f64]| corners.iter().map(|&corner| list[corner as usize]).sum::<f64>() / 3.0;
            let scale = mean(&density.scales);
            let spacing = scale.max((GROWTH * mean(&density.spacings)).min(largest));
            let is_far = |(corner, point): (&u32, &DVec3)| {
                let far = SQRT_2 * middle.distance(*point);
                far > spacing && far > density.spacings[*corner as usize]
            };
            // Twice the wanted number, because the estimate is rough: it only stops what would never end.
            if patch.points.len() < patch.rim + 2 * most && corners.iter().zip(&points).all(is_far) {
                patch.split(triangle, middle);
                density.scales.push(scale);
                density.spacings.push(spacing);
            }
        }
        let added = patch.points.len() - before;
        if added > 0 {
            flip_until_delaunay(patch);
            even(patch);
        }
        if added as f64 <= FEW * before as f64 {
            break;
        }
    }
    let is_coarse = |(spacing, scale): (&f64, &f64)| spacing > scale;
    !density.spacings.iter().zip(&density.scales).any(is_coarse)
}

/// The spacing at which a patch of equilateral triangles has this many points.
fn largest_spacing(patch: &Patch, most: usize) -> f64 {
    let area = |triangle: usize| {
        let [a, b, c] = patch.corners(triangle);
        0.5 * (b - a).cross(c - a).length()
    };
    let whole: f64 = (0..patch.triangles.len()).map(area).sum();
    (whole / (0.75_f64.sqrt() * most.max(1) as f64)).sqrt()
}

/// Moves the points inside along the patch towards the middle of their neighbours.
fn even(patch: &mut Patch) {
    for _ in 0..EVENING_ROUNDS {
        let middles = middles(patch);
        let normals = normals(patch);
        let moved: Vec<DVec3> = (patch.rim..patch.points.len())
            .map(|point| {
                let way = middles[point] - patch.points[point];
                patch.points[point] + (way - normals[point] * way.dot(normals[point]))
            })
            .collect();
        patch.points[patch.rim..].copy_from_slice(&moved);
        flip_until_delaunay(patch);
    }
}

/// The mean of each point's neighbours. Every neighbour of a point inside is in two of its triangles.
fn middles(patch: &Patch) -> Vec<DVec3> {
    let mut sums = vec![(DVec3::ZERO, 0.0); patch.points.len()];
    for &[a, b, c] in &patch.triangles {
        for [own, other, third] in [[a, b, c], [b, c, a], [c, a, b]] {
            let sum = &mut sums[own as usize];
            sum.0 += patch.points[other as usize] + patch.points[third as usize];
            sum.1 += 2.0;
        }
    }
    sums.into_iter()
        .map(|(sum, count)| sum / f64::max(count, 1.0))
        .collect()
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
