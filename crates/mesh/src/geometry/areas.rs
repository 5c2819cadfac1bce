//! Areas and volumes of whole surfaces.

use glam::DVec3;
use rayon::prelude::*;

use crate::geometry::{area_of_lengths, cotangents, edge_lengths, face_area};
use crate::surface::corners;
use crate::{Surface, SurfaceVertex};

/// Triangles per piece of a sum: the pieces do not depend on the number of threads.
const PIECE: usize = 16_384;

/// The area of every triangle of `surface` with its vertices at `positions`.
pub fn face_areas(surface: &Surface, positions: &[DVec3]) -> Vec<f64> {
    surface
        .triangles
        .par_iter()
        .map(|&triangle| face_area(corners(triangle, positions)))
        .collect()
}

/// Each corner's share of a triangle's area, from edge lengths (entry `i` opposite corner `i`) [MDSB03,
/// figure 4]. The shares sum to the area.
///
/// The circumcentre divides a triangle without an obtuse angle; a triangle with an obtuse angle gives half of its area
/// to that corner and a quarter to each of the others.
pub fn mixed_corner_areas(lengths: [f64; 3]) -> [f64; 3] {
    let area = area_of_lengths(lengths);
    if area <= 0.0 {
        return [0.0; 3];
    }
    let cot = cotangents(lengths);
    if let Some(obtuse) = (0..3).find(|&i| cot[i] < 0.0) {
        let mut shares = [0.25 * area; 3];
        shares[obtuse] = 0.5 * area;
        return shares;
    }
    // Equation 7: an edge's eighth of a square, weighted by the cotangent opposite, goes to both its ends.
    let of_edge: [f64; 3] = std::array::from_fn(|i| 0.125 * lengths[i] * lengths[i] * cot[i]);
    [
        of_edge[1] + of_edge[2],
        of_edge[2] + of_edge[0],
        of_edge[0] + of_edge[1],
    ]
}

/// The mixed Voronoi area of every vertex, all finite and not negative; they sum to the surface's area. It is 0 for a
/// vertex whose triangles all have no area, so callers that divide by it must bound it below.
pub fn mixed_voronoi_areas(surface: &Surface) -> Vec<f64> {
    let shares: Vec<[f64; 3]> = (0..surface.triangles.len())
        .into_par_iter()
        .map(|t| mixed_corner_areas(edge_lengths(surface.corners(t))))
        .collect();
    let mut areas = vec![0.0; surface.positions.len()];
    for (triangle, shares) in surface.triangles.iter().zip(&shares) {
        for (v, share) in triangle.iter().zip(shares) {
            areas[v.index()] += share;
        }
    }
    areas
}

/// The volume inside a closed surface, positive where normals point outward; meaningless for an open one.
pub fn signed_volume(triangles: &[[SurfaceVertex; 3]], positions: &[DVec3]) -> f64 {
    // Measured from a vertex of the surface, because far from the origin the terms would cancel.
    let Some(&[apex, ..]) = triangles.first() else {
        return 0.0;
    };
    let apex = positions[apex.index()];
    let pieces: Vec<f64> = triangles
        .par_chunks(PIECE)
        .map(|piece| {
            piece
                .iter()
                .map(|&triangle| {
                    let [a, b, c] = corners(triangle, positions).map(|p| p - apex);
                    a.dot(b.cross(c))
                })
                .sum()
        })
        .collect();
    pieces.iter().sum::<f64>() / 6.0
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::DAffine3;

    use super::*;
    use crate::shapes;

    #[test]
    fn volumes_are_those_of_the_shapes_wherever_they_stand() {
        let far = DAffine3::from_translation(DVec3::new(4e5, 5e6, 30.0));
        for (drawn, volume, error) in [
            (shapes::bar(3, 4, 5), 60.0, 1e-9),
            (shapes::icosphere(4), 4.0 / 3.0 * PI, 0.01),
            (shapes::torus(80, 40), 2.0 * PI * PI * 0.16, 0.03),
        ] {
            for drawn in [drawn.clone(), shapes::moved(&drawn, far)] {
                let model = shapes::model(drawn);
                let found = signed_volume(&model.surface.triangles, &model.surface.positions);
                assert!((found - volume).abs() < error + 1e-6, "{found} {volume}");
            }
        }
    }
}
