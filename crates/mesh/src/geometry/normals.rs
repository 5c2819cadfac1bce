//! Vertex normals, computed every frame.
//!
//! Each vertex gathers from its own surroundings, so the sums have the same bits for any number of threads. The
//! triangles around a regular vertex add up to the area vector of the polygon that its neighbours form (with the vertex
//! itself, if its fan is open), and a polygon's area vector is the sum over its quadrilaterals: half the cross product
//! of two diagonals. A vertex with six neighbours costs two cross products, and neither its own position nor any
//! triangle is looked up. Lengths are computed many at a time, by loops compiled for the machine's vectors.

use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use crate::geometry::vector3::{BLOCK, Vector3};
use crate::surface::corners;
use crate::vectors::vectors;
use crate::{FanKind, SurfaceVertex, Topology};

/// The number of vertices for one task.
const CHUNK: usize = 2048;

/// The unit normal of every vertex into `out`: the mean of its triangles' normals weighted by area. It is zero if no
/// triangle has an area; if the normals cancel it may have any direction.
///
/// In single precision a normal is off by the rounding of the positions over the length of an edge, and edges should be
/// between 1e-9 and 1e9 long, because the square of an area is taken.
pub fn vertex_normals<V: Vector3>(
    triangles: &[[SurfaceVertex; 3]],
    topology: &Topology,
    positions: &[V],
    out: &mut Vec<V>,
) {
    out.resize(positions.len(), V::ZERO);
    let around = Around {
        triangles,
        topology,
        positions,
    };
    let arch = vectors();
    out.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, normals)| {
        arch.dispatch(Fill {
            around,
            first: chunk * CHUNK,
            normals,
        });
    });
}

/// The input of the normals.
#[derive(Clone, Copy)]
struct Around<'a, V> {
    triangles: &'a [[SurfaceVertex; 3]],
    topology: &'a Topology,
    positions: &'a [V],
}

/// The unit normals of the vertices from `first` on.
///
/// A closure would be compiled without the vector instructions that its caller is compiled for.
struct Fill<'a, V> {
    around: Around<'a, V>,
    first: usize,
    normals: &'a mut [V],
}

impl<V: Vector3> WithSimd for Fill<'_, V> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.around.fill(self.first, self.normals);
    }
}

impl<V: Vector3> Around<'_, V> {
    /// The unit normals of the vertices from `first` on.
    #[inline(always)]
    fn fill(self, first: usize, normals: &mut [V]) {
        for (normals, first) in normals.chunks_mut(BLOCK).zip((first..).step_by(BLOCK)) {
            for (normal, v) in normals.iter_mut().zip(first..) {
                *normal = self.sum(SurfaceVertex(v as u32));
            }
            V::normalize_all(normals);
        }
    }

    /// Twice the area-weighted normals of the triangles at `v`.
    #[inline(always)]
    fn sum(self, v: SurfaceVertex) -> V {
        match self.topology.ring_and_fan(v) {
            (FanKind::Closed, ring, [first, rest @ ..]) => self.polygon(ring[usize::from(*first)], ring, rest),
            (FanKind::Open, ring, fan) => self.polygon(v, ring, fan),
            _ => self.triangles(v),
        }
    }

    /// Twice the area vector of the polygon from `corner` along `chain` and back; `chain` has places in `ring`.
    #[inline(always)]
    fn polygon(self, corner: SurfaceVertex, ring: &[SurfaceVertex], chain: &[u8]) -> V {
        let at = |place: u8| self.positions[ring[usize::from(place)].index()];
        let Some((&first, rest)) = chain.split_first() else {
            return V::ZERO;
        };
        let (corner, mut before) = (self.positions[corner.index()], at(first));
        let mut sum = V::ZERO;
        let pairs = rest.chunks_exact(2);
        let last = pairs.remainder().first();
        for pair in pairs {
            let after = at(pair[1]);
            sum += (at(pair[0]) - corner).cross(after - before);
            before = after;
        }
        match last {
            Some(&last) => sum + (before - corner).cross(at(last) - corner),
            None => sum,
        }
    }

    /// The same sum, for any triangles.
    fn triangles(self, v: SurfaceVertex) -> V {
        let doubled_area = |t: u32| {
            let [a, b, c] = corners(self.triangles[t as usize], self.positions);
            (b - a).cross(c - a)
        };
        self.topology.faces(v, self.triangles).map(doubled_area).sum()
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3A};

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
            // In single precision the same, up to its accuracy.
            let centre = model.bounds().map_or(DVec3::ZERO, |bounds| bounds.centre());
            let single: Vec<Vec3A> = surface.positions.iter().map(|p| (*p - centre).as_vec3a()).collect();
            let mut rounded = Vec::new();
            vertex_normals(&surface.triangles, &model.topology, &single, &mut rounded);
            for v in 0..normals.len() {
                let cancels = sums[v].length() <= 1e-4 * areas[v].max(1e-6);
                assert!(
                    cancels || normals[v].abs_diff_eq(rounded[v].as_dvec3(), 1e-3),
                    "{class}: {} {}",
                    normals[v],
                    rounded[v]
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
