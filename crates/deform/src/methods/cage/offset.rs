//! Makes a cage for a region: the surface of voxels around it, smoothed.

use std::collections::BTreeMap;

use glam::{DVec3, I64Vec3};

use super::mesh::CageMesh;
use super::voxels::Voxels;

/// The largest move of a vertex by the smoothing, in voxels. The region is at least one voxel within their surface, so
/// at least 0.7 voxels within the cage: that is the reach of the splines of harmonic coordinates over their grid, 2 √3
/// steps of a fifth of a voxel.
const SMOOTHING: f64 = 0.3;

/// The number of rounds in which vertices move to the middle of their neighbours.
const ROUNDS: usize = 3;

/// Makes a closed 2-manifold around all of the points and along the triangles between them, with `detail` voxels on the
/// longest side of the points' box. It has a part for each group of points that are far apart.
pub(crate) fn offset_cage(points: &[DVec3], triangles: impl Iterator<Item = [DVec3; 3]>, detail: u32) -> CageMesh {
    let (low, high) = bounds(points);
    let voxel = voxel_size(points, detail);
    let along = triangles.flat_map(|corners| spread(corners, 0.5 * voxel));
    let voxels = Voxels::around(points.iter().copied().chain(along), low, high - low, voxel);
    smoothed(surface(&voxels), SMOOTHING * voxel)
}

/// The side of a voxel if the longest side of the points' box has `detail` of them.
pub(crate) fn voxel_size(points: &[DVec3], detail: u32) -> f64 {
    let (low, high) = bounds(points);
    let longest = (high - low).max_element();
    if longest > 0.0 {
        longest / f64::from(detail)
    } else {
        1.0
    }
}

/// The points' box; the origin without points.
fn bounds(points: &[DVec3]) -> (DVec3, DVec3) {
    let (low, high) = points
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &point| {
            (low.min(point), high.max(point))
        });
    match low.is_finite() {
        true => (low, high),
        false => (DVec3::ZERO, DVec3::ZERO),
    }
}

/// Points on a triangle at distances of at most about `step`.
fn spread([a, b, c]: [DVec3; 3], step: f64) -> impl Iterator<Item = DVec3> {
    // The lengths are in steps, because the square of a length in world units may overflow.
    let steps = [b - a, c - b, a - c].map(|side| (side / step).length());
    let count = steps.into_iter().fold(1.0, f64::max).ceil() as usize;
    let at = move |share: usize| share as f64 / count as f64;
    (0..=count).flat_map(move |i| (0..=count - i).map(move |j| a + (b - a) * at(i) + (c - a) * at(j)))
}

/// The faces between voxels of the set and others, two triangles each.
fn surface(voxels: &Voxels) -> CageMesh {
    let mut numbers: BTreeMap<[i64; 3], u32> = BTreeMap::new();
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for cell in voxels.cells() {
        for axis in 0..3 {
            let [along, a, b] = [0, 1, 2].map(|turn| I64Vec3::AXES[(axis + turn) % 3]);
            for is_ahead in [true, false] {
                if voxels.contains(if is_ahead { cell + along } else { cell - along }) {
                    continue;
                }
                let first = if is_ahead { cell + along } else { cell };
                // The corners are counterclockwise seen from outside.
                let (a, b) = if is_ahead { (a, b) } else { (b, a) };
                let corners = [first, first + a, first + a + b, first + b].map(|corner| {
                    *numbers.entry(corner.to_array()).or_insert_with(|| {
                        vertices.push(voxels.low + corner.as_dvec3() * voxels.size);
                        vertices.len() as u32 - 1
                    })
                });
                let [p, q, r, s] = corners;
                // Diagonals alternate, so that the cage prefers no side.
                if (first.x + first.y + first.z) % 2 == 0 {
                    faces.extend([[p, q, r], [p, r, s]]);
                } else {
                    faces.extend([[p, q, s], [q, r, s]]);
                }
            }
        }
    }
    CageMesh::new(vertices, faces)
}

/// Moves vertices to the middle of their neighbours, each at most `most` from its first position.
fn smoothed(mut mesh: CageMesh, most: f64) -> CageMesh {
    let neighbours = mesh.neighbours();
    let rest = mesh.vertices.clone();
    for _ in 0..ROUNDS {
        let middles = neighbours.iter().map(|own| {
            let sum: DVec3 = own.iter().map(|&other| mesh.vertices[other as usize]).sum();
            sum / own.len() as f64
        });
        let middles: Vec<DVec3> = middles.collect();
        for ((vertex, middle), rest) in mesh.vertices.iter_mut().zip(middles).zip(&rest) {
            *vertex = *rest + (0.5 * (*vertex + middle) - *rest).clamp_length_max(most);
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_spread_as_densely_whatever_its_size() {
        for size in [1e-300, 1.0, 1e300] {
            let points: Vec<DVec3> = spread([DVec3::ZERO, DVec3::X * size, DVec3::Y * size], 0.1 * size).collect();
            // Its longest side takes 14.2 steps.
            assert_eq!(points.len(), 16 * 17 / 2, "{size}");
            let cage = offset_cage(&[DVec3::ZERO, DVec3::X * size, DVec3::Y * size], std::iter::empty(), 4);
            assert!(
                !cage.vertices.is_empty() && cage.vertices.iter().all(|v| v.is_finite()),
                "{size}"
            );
        }
    }
}
