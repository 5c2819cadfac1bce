//! Vertex normals, every frame.
//!
//! Each vertex gathers from its own surroundings, so the sums are the same bits whatever the number of threads. A
//! regular vertex walks its fan of neighbours, where two triangles next to each other share a cross product:
//! a × b + b × c = b × (c − a). That is half the products and no look-up of triangles; gathering triangles took more
//! than twice the time.

use glam::DVec3;
use rayon::prelude::*;

use crate::surface::corners;
use crate::{FanKind, SurfaceVertex, Topology};

/// The unit normal of every vertex into `out`: the mean of its triangles' normals weighted by area. Where none has an
/// area, or where they cancel, zero or whichever way rounding points.
pub fn vertex_normals(
    triangles: &[[SurfaceVertex; 3]],
    topology: &Topology,
    positions: &[DVec3],
    out: &mut Vec<DVec3>,
) {
    out.resize(positions.len(), DVec3::ZERO);
    out.par_chunks_mut(2048).enumerate().for_each(|(piece, normals)| {
        for (i, normal) in normals.iter_mut().enumerate() {
            let v = SurfaceVertex((piece * 2048 + i) as u32);
            let sum = match topology.ring_and_fan(v) {
                (FanKind::Irregular, ..) => sum_of_triangles(v, triangles, topology, positions),
                (kind, ring, fan) => sum_of_fan(positions[v.index()], kind, ring, fan, positions),
            };
            *normal = sum.normalize_or_zero();
        }
    });
}

/// Twice the area-weighted normals of the triangles between neighbours of `centre`: `fan` has their places in `ring`.
#[inline]
fn sum_of_fan(centre: DVec3, kind: FanKind, ring: &[SurfaceVertex], fan: &[u8], positions: &[DVec3]) -> DVec3 {
    let spoke = |place: u8| positions[ring[usize::from(place)].index()] - centre;
    let first = spoke(fan[0]);
    let mut sum = DVec3::ZERO;
    let mut before = first;
    let pairs = fan[1..].chunks_exact(2);
    let single = pairs.remainder().first();
    for pair in pairs {
        let after = spoke(pair[1]);
        sum += spoke(pair[0]).cross(after - before);
        before = after;
    }
    match (single, kind) {
        (Some(&last), FanKind::Closed) => sum + spoke(last).cross(first - before),
        (Some(&last), _) => sum + before.cross(spoke(last)),
        (None, FanKind::Closed) => sum + before.cross(first),
        (None, _) => sum,
    }
}

/// The same sum, whatever the triangles look like.
fn sum_of_triangles(
    v: SurfaceVertex,
    triangles: &[[SurfaceVertex; 3]],
    topology: &Topology,
    positions: &[DVec3],
) -> DVec3 {
    let faces = topology.faces(v).iter();
    faces
        .map(|&t| {
            let [a, b, c] = corners(triangles[t as usize], positions);
            (b - a).cross(c - a)
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{face_area, face_normal, shapes};

    #[test]
    fn a_normal_is_the_mean_of_its_triangles_weighted_by_area() {
        for (class, drawn) in shapes::classes() {
            let model = shapes::model(drawn);
            let surface = &model.surface;
            let mut normals = Vec::new();
            vertex_normals(&surface.triangles, &model.topology, &surface.positions, &mut normals);
            let mut sums = vec![DVec3::ZERO; normals.len()];
            let mut areas = vec![0.0; normals.len()];
            for (t, triangle) in surface.triangles.iter().enumerate() {
                let corners = surface.corners(t);
                for v in triangle {
                    sums[v.index()] += face_normal(corners) * face_area(corners);
                    areas[v.index()] += face_area(corners);
                }
            }
            for v in 0..normals.len() {
                let expected = sums[v].normalize_or_zero();
                let cancels = sums[v].length() <= 1e-9 * areas[v].max(1e-6);
                assert!(
                    cancels || normals[v].abs_diff_eq(expected, 1e-7),
                    "{class}: {} {expected}",
                    normals[v]
                );
            }
        }
    }

    #[test]
    fn normals_of_a_sphere_point_outward() {
        let model = shapes::model(shapes::uv_sphere(40, 60));
        let mut normals = Vec::new();
        vertex_normals(
            &model.surface.triangles,
            &model.topology,
            &model.surface.positions,
            &mut normals,
        );
        assert!(
            normals
                .iter()
                .zip(&model.surface.positions)
                .all(|(n, p)| n.dot(*p) > 0.99)
        );
    }
}
