//! Curvature of a surface at its vertices.

use glam::DVec3;
use rayon::prelude::*;

use super::{cotangents, edge_lengths, mixed_corner_areas};
use crate::{Surface, SurfaceVertex, Topology};

/// Mean curvature of each vertex with the surface's vertices at `positions`, by the cotangent formula (\[MDSB03\], eq.
/// 8), in 1/unit, positive where it is convex; 0 at the boundary and where the area is zero.
pub fn mean_curvatures(surface: &Surface, topology: &Topology, positions: &[DVec3]) -> Vec<f64> {
    let triangles = &surface.triangles;
    let faces: Vec<([f64; 3], [f64; 3], DVec3)> = triangles
        .par_iter()
        .map(|triangle| {
            let corners = triangle.map(|corner| positions[corner.index()]);
            let lengths = edge_lengths(corners);
            let [a, b, c] = corners;
            (cotangents(lengths), mixed_corner_areas(lengths), (b - a).cross(c - a))
        })
        .collect();
    (0..positions.len() as u32)
        .into_par_iter()
        .map(|v| {
            let v = SurfaceVertex(v);
            if topology.is_boundary_vertex(v) {
                return 0.0;
            }
            let (mut pull, mut area, mut normal) = (DVec3::ZERO, 0.0, DVec3::ZERO);
            for face in topology.faces(v, triangles) {
                let corners = triangles[face as usize];
                let (cotangents, areas, doubled) = &faces[face as usize];
                let Some(at) = corners.iter().position(|&corner| corner == v) else {
                    continue;
                };
                let (next, last) = ((at + 1) % 3, (at + 2) % 3);
                let here = positions[v.index()];
                // The edge to one corner is opposite to the other corner.
                pull += cotangents[last] * (here - positions[corners[next].index()]);
                pull += cotangents[next] * (here - positions[corners[last].index()]);
                area += areas[at];
                normal += *doubled;
            }
            let curvature = 0.25 * pull.dot(normal.normalize_or_zero()) / area;
            if curvature.is_finite() { curvature } else { 0.0 }
        })
        .collect()
}
