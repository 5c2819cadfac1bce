//! Mean value coordinates of closed triangle meshes [JSW05], and their gradients.
//!
//! A face's mean vector m is the integral of the unit normals over the spherical triangle in which a point p sees it: m
//! = ½ Σ_k θ_k N_k, with θ_k the angle at p under the edge opposite to corner k and N_k the unit normal of the plane
//! through p and this edge. With e_i from p to the corners and c_i = e_{i+1} × e_{i+2} the face gives its corner i the
//! weight w_i = c_i · m / D, D = e_0 · c_0, so that Σ w_i e_i = m. Over a closed mesh the mean vectors sum to zero.
//!
//! The code computes eight points at a time, edge by edge and then face by face. [`super::mean_value_at`] computes
//! points in the plane of a face, where D is zero, one by one.

use glam::DVec3;
use pliant_mesh::vectors;
use pulp::{Simd, WithSimd};

use super::mean_value_at::{COPLANAR, Weight, at_any, normalised};
use super::mesh::CageMesh;
use crate::numerical::lanes::{LANES, Lanes, Vector};

/// A cage for mean value coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeanValue<'a> {
    cage: &'a CageMesh,
}

/// The quantities of an edge: c, M = ½ θ N, and its derivative column by column.
type AtEdge = [Lanes; 15];

/// Scratch memory for a group of points.
#[derive(Default)]
struct Scratch {
    /// The vectors from the points to each vertex, and the distances.
    spokes: Vec<[Lanes; 4]>,
    edges: Vec<AtEdge>,
    /// Each vertex' weight and the weight's gradient.
    weights: Vec<[Lanes; 4]>,
    /// Not zero for a point that must be computed alone.
    doubts: Lanes,
}

impl<'a> MeanValue<'a> {
    pub fn new(cage: &'a CageMesh) -> Self {
        Self { cage }
    }

    /// The count of coordinates.
    pub fn count(&self) -> usize {
        self.cage.vertices.len()
    }

    /// Visits each point's coordinates: one for each vertex with its gradient. They sum to 1, and Σ λ_i v_i is the
    /// point.
    pub fn at(&self, points: &[DVec3], mut visit: impl FnMut(usize, &[Weight])) {
        let count = self.cage.vertices.len();
        let mut scratch = Scratch {
            spokes: vec![Default::default(); count],
            edges: vec![Default::default(); self.cage.edges.len()],
            weights: vec![Default::default(); count],
            doubts: Lanes::default(),
        };
        let arch = vectors();
        let mut own: Vec<Weight> = vec![Default::default(); count];
        for (group, points) in points.chunks(LANES).enumerate() {
            arch.dispatch(Group {
                cage: self.cage,
                points,
                scratch: &mut scratch,
            });
            for (lane, &point) in points.iter().enumerate() {
                for (own, weight) in own.iter_mut().zip(&scratch.weights) {
                    let [value, x, y, z] = weight.each_ref().map(|lanes| lanes.0[lane]);
                    *own = (value, DVec3::new(x, y, z));
                }
                let is_sure = scratch.doubts.0[lane] == 0.0 && normalised(&mut own);
                if !is_sure {
                    at_any(self.cage, point, &mut own);
                }
                visit(group * LANES + lane, &own);
            }
        }
    }
}

/// Up to eight points.
struct Group<'a> {
    cage: &'a CageMesh,
    points: &'a [DVec3],
    scratch: &'a mut Scratch,
}

impl WithSimd for Group<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { cage, points, scratch } = self;
        let mut lanes = [Lanes::default(); 3];
        for lane in 0..LANES {
            // Empty lanes repeat the last point.
            let point = points[lane.min(points.len() - 1)];
            for k in 0..3 {
                lanes[k].0[lane] = point[k];
            }
        }
        scratch.weights.fill(Default::default());
        for place in 0..LANES / S::F64_LANES {
            let point = Vector::each(simd, &lanes, place);
            for (spoke, vertex) in scratch.spokes.iter_mut().zip(&cage.vertices) {
                let e = [0, 1, 2].map(
                    #[inline(always)]
                    |k| Vector::splat(simd, vertex[k]) - point[k],
                );
                Vector::put_each([e[0], e[1], e[2], dot(e, e).sqrt()], spoke, place);
            }
            for (edge, &[a, b]) in scratch.edges.iter_mut().zip(&cage.edges) {
                let [a, b] = [&scratch.spokes[a as usize], &scratch.spokes[b as usize]];
                at_edge(
                    simd,
                    Vector::each(simd, a, place),
                    Vector::each(simd, b, place),
                    edge,
                    place,
                );
            }
            let mut doubts = Vector::splat(simd, 0.0);
            for (face, sides) in cage.faces.iter().zip(&cage.sides) {
                let mut sum = [Vector::splat(simd, 0.0); 12];
                let mut crosses = [[Vector::splat(simd, 0.0); 3]; 3];
                for (corner, side) in sides.iter().enumerate() {
                    let edge = Vector::each(simd, &scratch.edges[side.edge as usize], place);
                    let sign = Vector::splat(simd, side.sign);
                    for k in 0..3 {
                        crosses[corner][k] = edge[k] * sign;
                    }
                    for k in 0..12 {
                        sum[k] = sum[k] + edge[3 + k] * sign;
                    }
                }
                let m = [sum[0], sum[1], sum[2]];
                let spokes = face.map(
                    #[inline(always)]
                    |vertex| Vector::each(simd, &scratch.spokes[vertex as usize], place),
                );
                let [one, two, three] = spokes;
                let volume = dot([one[0], one[1], one[2]], crosses[0]);
                let least = Vector::splat(simd, COPLANAR) * (one[3] * two[3] * three[3]);
                let doubt = Vector::splat(simd, 1.0).or(least.less(volume.abs()), Vector::splat(simd, 0.0));
                doubts = doubts + (Vector::splat(simd, 1.0) - doubt);
                let inverse = Vector::splat(simd, 1.0) / volume;
                // Twice the face's area vector, −∇D.
                let area = sums(sums(crosses[0], crosses[1]), crosses[2]);
                for corner in 0..3 {
                    let c = crosses[corner];
                    let weight = dot(c, m) * inverse;
                    let (from, to) = (spokes[(corner + 1) % 3], spokes[(corner + 2) % 3]);
                    let along = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
                    let turned = cross(m, along);
                    let own = &mut scratch.weights[face[corner] as usize];
                    let mut total = Vector::each(simd, own, place);
                    total[0] = total[0] + weight;
                    for axis in 0..3 {
                        let column = [sum[3 + 3 * axis], sum[4 + 3 * axis], sum[5 + 3 * axis]];
                        let slope = (turned[axis] + dot(column, c) + weight * area[axis]) * inverse;
                        total[1 + axis] = total[1 + axis] + slope;
                    }
                    Vector::put_each(total, own, place);
                }
            }
            doubts.put(&mut scratch.doubts, place);
        }
    }
}

/// c = a × b, M = ½ θ N with N = c / |c|, and ∂M along x, y and z.
#[inline(always)]
fn at_edge<S: Simd>(simd: S, a: [Vector<S>; 4], b: [Vector<S>; 4], out: &mut AtEdge, place: usize) {
    let (from, to) = ([a[0], a[1], a[2]], [b[0], b[1], b[2]]);
    let c = cross(from, to);
    let length = dot(c, c).sqrt();
    let one = Vector::splat(simd, 1.0);
    // tan ½ θ, and by two more halvings an argument for the arc tangent's fraction.
    let half = length / (a[3] * b[3] + dot(from, to));
    let quarter = half / (one + (one + half * half).sqrt());
    let eighth = quarter / (one + (one + quarter * quarter).sqrt());
    let angle = arc_tangent(simd, eighth) * Vector::splat(simd, 4.0);
    let inverse = one / length;
    let n = scaled(c, inverse);
    // ∇½θ = ½ N × (a / |a|² − b / |b|²).
    let a_square = Vector::splat(simd, 0.5) / (a[3] * a[3]);
    let b_square = Vector::splat(simd, 0.5) / (b[3] * b[3]);
    let slope = cross(n, differences(scaled(from, a_square), scaled(to, b_square)));
    let e = differences(to, from);
    let g = cross(n, e);
    let share = angle * inverse;
    let zero = Vector::splat(simd, 0.0);
    // E × each axis.
    let moved = [[zero, e[2], -e[1]], [-e[2], zero, e[0]], [e[1], -e[0], zero]];
    let mut all = [zero; 15];
    for k in 0..3 {
        all[k] = c[k];
        all[3 + k] = n[k] * angle;
        for axis in 0..3 {
            all[6 + 3 * axis + k] = n[k] * slope[axis] + share * (moved[axis][k] - n[k] * g[axis]);
        }
    }
    Vector::put_each(all, out, place);
}

/// Twice half the arc tangent of numbers up to tan π/8, to the last digits: the fraction of the Cephes library.
#[inline(always)]
fn arc_tangent<S: Simd>(simd: S, x: Vector<S>) -> Vector<S> {
    const ABOVE: [f64; 5] = [
        -8.750_608_600_031_904e-1,
        -1.615_753_718_733_365e1,
        -7.500_855_792_314_705e1,
        -1.228_866_684_490_136_2e2,
        -6.485_021_904_942_025e1,
    ];
    const BELOW: [f64; 6] = [
        1.0,
        2.485_846_490_142_306_3e1,
        1.650_270_098_316_988_5e2,
        4.328_810_604_912_903e2,
        4.853_903_996_359_137e2,
        1.945_506_571_482_614e2,
    ];
    let square = x * x;
    let mut above = Vector::splat(simd, ABOVE[0]);
    for factor in &ABOVE[1..] {
        above = above * square + Vector::splat(simd, *factor);
    }
    let mut below = Vector::splat(simd, BELOW[0]);
    for factor in &BELOW[1..] {
        below = below * square + Vector::splat(simd, *factor);
    }
    x * square * above / below + x
}

#[inline(always)]
fn dot<S: Simd>(a: [Vector<S>; 3], b: [Vector<S>; 3]) -> Vector<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross<S: Simd>(a: [Vector<S>; 3], b: [Vector<S>; 3]) -> [Vector<S>; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[inline(always)]
fn sums<S: Simd>(a: [Vector<S>; 3], b: [Vector<S>; 3]) -> [Vector<S>; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn differences<S: Simd>(a: [Vector<S>; 3], b: [Vector<S>; 3]) -> [Vector<S>; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn scaled<S: Simd>(a: [Vector<S>; 3], factor: Vector<S>) -> [Vector<S>; 3] {
    [a[0] * factor, a[1] * factor, a[2] * factor]
}
