//! Sums of the kernel |p − x|³ over all centres, and their gradients, eight points at a time.

use glam::DVec3;
use pliant_mesh::vectors;
use pulp::{Simd, WithSimd};

use crate::numerical::lanes::{LANES, Lanes, Vector};

/// The coefficients of a field: four columns per handle.
#[derive(Clone, Debug, Default)]
pub(super) struct Weights {
    pub centres: Vec<DVec3>,
    /// Row-major: one entry per centre and handle.
    pub of_centres: Vec<[f64; 4]>,
    pub handle_count: usize,
    /// The linear part: for each handle the constant, and the factors of x, y and z.
    pub linear: Vec<[[f64; 4]; 4]>,
}

/// The value of a field's four columns at a point, and their slopes along x, y and z.
pub(super) type Sum = [[f64; 4]; 4];

impl Weights {
    /// The field of one handle at points.
    pub fn evaluate(&self, handle: usize, points: &[DVec3], out: &mut [Sum]) {
        let arch = vectors();
        for (points, out) in points.chunks(LANES).zip(out.chunks_mut(LANES)) {
            arch.dispatch(Group {
                weights: self,
                handle,
                points,
                out,
            });
        }
    }
}

/// Up to eight points.
struct Group<'a> {
    weights: &'a Weights,
    handle: usize,
    points: &'a [DVec3],
    out: &'a mut [Sum],
}

impl WithSimd for Group<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            weights,
            handle,
            points,
            out,
        } = self;
        let mut lanes = [Lanes::default(); 3];
        for lane in 0..LANES {
            // Empty lanes repeat the last point.
            let point = points[lane.min(points.len() - 1)];
            for k in 0..3 {
                lanes[k].0[lane] = point[k];
            }
        }
        let mut sums = [Lanes::default(); 16];
        for place in 0..LANES / S::F64_LANES {
            let point = Vector::each(simd, &lanes, place);
            let mut sum = [Vector::splat(simd, 0.0); 16];
            let own = weights.of_centres.iter().skip(handle).step_by(weights.handle_count);
            for (centre, column) in weights.centres.iter().zip(own) {
                let x = point[0] - Vector::splat(simd, centre.x);
                let y = point[1] - Vector::splat(simd, centre.y);
                let z = point[2] - Vector::splat(simd, centre.z);
                let square = x * x + y * y + z * z;
                let distance = square.sqrt();
                let cube = square * distance;
                let slope = distance * Vector::splat(simd, 3.0);
                let (x, y, z) = (x * slope, y * slope, z * slope);
                for k in 0..4 {
                    let weight = Vector::splat(simd, column[k]);
                    sum[k] = sum[k] + cube * weight;
                    sum[4 + k] = sum[4 + k] + x * weight;
                    sum[8 + k] = sum[8 + k] + y * weight;
                    sum[12 + k] = sum[12 + k] + z * weight;
                }
            }
            Vector::put_each(sum, &mut sums, place);
        }
        let linear = &weights.linear[handle];
        for (lane, (out, point)) in out.iter_mut().zip(points).enumerate() {
            for k in 0..4 {
                let slopes = [1, 2, 3].map(|axis| linear[axis][k]);
                out[0][k] = sums[k].0[lane] + linear[0][k] + DVec3::from_array(slopes).dot(*point);
                for axis in 1..4 {
                    out[axis][k] = sums[4 * axis + k].0[lane] + slopes[axis - 1];
                }
            }
        }
    }
}
