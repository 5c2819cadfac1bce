//! The fit of affine maps, which is linear in the handles' motions.
//!
//! With the displacement u(x) = L x + s of each handle, its moments w, v and Q about the place p, the mean c and the
//! covariance K of all points, and q = K⁻¹ c, the displacement u* − D q of [`super::fit`] is
//!
//! d(p) = Σ_h L_h a_h + b_h s_h,   b = w (1 + c·q) − v·q,   a = b p + v (1 + c·q) − Q q.
//!
//! So each handle has four coefficients at a vertex, and a frame is a product.

use glam::DVec3;

use super::moments::{Moments, first, moments_at, second};
use super::points::Points;
use crate::space::field::{Coefficients, SpaceMap};
use crate::space::hand_field::outer;

/// The field of affine fits.
pub(super) struct AffineMap<'a> {
    pub points: &'a Points,
    pub half_falloff: f64,
    pub positions: &'a [DVec3],
    /// The origin in each handle's coordinates, and its radius.
    pub handles: &'a [(DVec3, f64)],
}

/// 1 + c·q, and q; or both derivatives along an axis.
struct Dual {
    scale: f64,
    q: DVec3,
}

impl SpaceMap for AffineMap<'_> {
    fn coefficients(&self, world_points: &[DVec3], out: &mut [Coefficients]) {
        let count = self.handles.len();
        for (&world_point, out) in world_points.iter().zip(out.chunks_exact_mut(count)) {
            let place = self.points.unit.local(world_point);
            let moments = moments_at(self.points, self.half_falloff, self.positions, world_point);
            let total = &moments.total;
            let c = first(&total.moments);
            let k_inverse = (second(&total.moments) - outer(c, c)).inverse();
            let q = k_inverse * c;
            let own = Dual {
                scale: 1.0 + c.dot(q),
                q,
            };
            let slopes = [0, 1, 2].map(|axis| {
                let c_slope = first(&total.slopes[axis]);
                let k_slope = second(&total.slopes[axis]) - outer(c_slope, c) - outer(c, c_slope);
                let q_slope = k_inverse * (c_slope - k_slope * q);
                Dual {
                    scale: c_slope.dot(q) + c.dot(q_slope),
                    q: q_slope,
                }
            });
            let of_handles = moments.sets.iter().zip(self.handles);
            for (out, (set, &(origin, radius))) in out.iter_mut().zip(of_handles) {
                let in_handle = |(a, b): (DVec3, f64)| {
                    let a = a * (self.points.unit.length / radius) + origin * b;
                    [a.x, a.y, a.z, b]
                };
                let value = coefficients(&set.moments, &own, place);
                out.value = in_handle(value);
                for axis in 0..3 {
                    // Each product's derivative is the sum of those in which one factor is derived.
                    let of_set = coefficients(&set.slopes[axis], &own, place);
                    let of_dual = coefficients(&set.moments, &slopes[axis], place);
                    let a = of_set.0 + of_dual.0 + DVec3::AXES[axis] * value.1;
                    let slope = in_handle((a, of_set.1 + of_dual.1));
                    for k in 0..4 {
                        out.gradient[k][axis] = slope[k] / self.points.unit.length;
                    }
                }
            }
        }
    }
}

/// a and b of one set.
fn coefficients(moments: &Moments, dual: &Dual, place: DVec3) -> (DVec3, f64) {
    let v = first(moments);
    let b = moments[0] * dual.scale - v.dot(dual.q);
    (place * b + v * dual.scale - second(moments) * dual.q, b)
}
