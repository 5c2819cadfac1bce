//! Vectors at the corners of many triangles at a time, brought into the triangles' planes.

use glam::DVec2;

use crate::fans::Fans;
use crate::lanes::{LANES, Lanes, Vectors, change, put, turn, vector};
use crate::plane::turned_back;

/// What the corners of several triangles have of a field that is given in the tangent planes of vertices.
pub(crate) struct Corners {
    /// The vectors in the vertices' planes.
    vectors: [Vectors; 3],
    /// The rotations from the triangles' planes to those, in the middles of the corners.
    rotations: [Vectors; 3],
    /// By how much the rotations at the corners' last edges are more than at their first ones.
    twists: [Lanes; 3],
}

impl Corners {
    pub fn new() -> Self {
        Self {
            vectors: [[[0.0; LANES]; 2]; 3],
            rotations: [[[0.0; LANES]; 2]; 3],
            twists: [[0.0; LANES]; 3],
        }
    }

    /// Reads a field at the corners of a triangle, which becomes that of number `i`.
    #[inline(always)]
    pub fn read(&mut self, i: usize, fans: &Fans, (triangle, vertices): (usize, [usize; 3]), field: &[DVec2]) {
        let (rotations, twists) = (fans.rotations(triangle), fans.twists(triangle));
        for k in 0..3 {
            put(&mut self.vectors[k], i, field[vertices[k]]);
            put(&mut self.rotations[k], i, rotations[k]);
            self.twists[k][i] = twists[k];
        }
    }

    /// The field at places of these barycentric coordinates, in the triangles' planes. It is continuous across edges:
    /// along the ray of points at which the coordinates of the other two corners have the same ratio, a corner's vector
    /// comes with the same rotation, and rays along an edge have the same one in both of its triangles.
    #[inline(always)]
    pub fn interpolate(&mut self, weights: &[Lanes; 3]) -> Vectors {
        let mut sum = [[0.0; LANES]; 2];
        for k in 0..3 {
            let [own, after, before] = [k, (k + 1) % 3, (k + 2) % 3].map(|corner| &weights[corner]);
            turn(&mut self.rotations[k], &along_ray([after, before], &self.twists[k]));
            let (rotations, vectors) = (&self.rotations[k], &self.vectors[k]);
            change(&mut sum, |i, sum| {
                sum + turned_back(vector(rotations, i), vector(vectors, i)) * own[i]
            });
        }
        sum
    }

    /// The vectors of corner `k` in the triangles' planes: along the corner's first edge and along its last one, to the
    /// next corner and to the one before.
    #[inline(always)]
    pub fn at_edges(&mut self, k: usize) -> [Vectors; 2] {
        let mut middles = self.vectors[k];
        let rotations = &self.rotations[k];
        change(&mut middles, |i, vector_here| {
            turned_back(vector(rotations, i), vector_here)
        });
        let halves = self.twists[k].map(|twist| 0.5 * twist);
        let mut both = [middles; 2];
        turn(&mut both[0], &halves);
        turn(&mut both[1], &halves.map(|half| -half));
        both
    }
}

/// By how much the rotation at a corner with this twist is more than in its middle for vectors that come along the ray of
/// points at which the coordinates of the next and the last corner have the ratio of `after` to `before`.
#[inline(always)]
pub(crate) fn along_ray([after, before]: [&Lanes; 2], twists: &Lanes) -> Lanes {
    let mut angles = [0.0; LANES];
    for (i, angle) in angles.iter_mut().enumerate() {
        let both = after[i] + before[i];
        let turn = (before[i] / both - 0.5) * twists[i];
        *angle = if both > 0.0 { turn } else { 0.0 };
    }
    angles
}
