//! The rotation R that maximises tr(Rᵀ S) for a 3×3 matrix S: a cell's best rotation, S = Σ w e' eᵀ.
//!
//! It uses Newton's method on the rotations, started from the last one. With B = Rᵀ S, a the axial vector of B's skew
//! part and H = tr(B) I − sym(B), the step is R ← R exp(H⁻¹ a), and a rotation is the maximum exactly if a = 0 and H is
//! positive semidefinite: every other critical point is a saddle or a minimum. So one or two steps from a warm start
//! are enough, reflected and flat cells need no special case, and cells that the test of H refuses are solved again from
//! the largest eigenvector of Horn's 4×4 matrix, which is always a proper rotation: from a quick one (see
//! `quick_rotation`) if Newton's method confirms it, or else from that of Jacobi's method (see `rigid_fit`).

use glam::{DMat3, DQuat, DVec3};

use crate::numerical::quick_rotation::quick_rotation;
use crate::numerical::rigid_fit::best_rotation;

/// The number of Newton steps before a start is given up.
pub(crate) const STEPS: u32 = 6;

/// A skew part below this, in units of tr(B), counts as zero.
pub(crate) const STATIONARY: f64 = 1e-14;

/// After a rotation by less than this, in radians, no further step is needed: convergence is at least quadratic, and
/// the error enters the energy squared once more. Near the end of a descent its steps get smaller and the rotations
/// exact.
pub(crate) const SMALL_RAD: f64 = 3e-3;

/// The same for a rotation that no later step corrects: its error is that of rounding.
const EXACT_RAD: f64 = 1e-7;

/// The addition to H, in units of its trace: a cell with edges on one line does not determine the turn about it, and
/// keeps its present one.
pub(crate) const OPEN: f64 = 1e-12;

/// The best rotation for `s`, from the guess `start`; `start` itself if `s` is zero or not finite.
#[inline]
pub(crate) fn fit(s: &DMat3, start: DQuat) -> DQuat {
    newton(s, start, SMALL_RAD).unwrap_or_else(|| fit_anew(s, start))
}

/// Like [`fit`], up to rounding. A rotation that [`fit`] found from a near guess is wrong by the square of the distance.
pub(crate) fn fit_exactly(s: &DMat3, start: DQuat) -> DQuat {
    newton(s, start, EXACT_RAD).unwrap_or_else(|| fit_anew(s, start))
}

/// Like [`fit_exactly`], if Newton's method from `start` did not converge.
#[cold]
pub(crate) fn fit_anew(s: &DMat3, start: DQuat) -> DQuat {
    let size = s.to_cols_array().into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    if !(size > 0.0 && s.is_finite()) {
        return start;
    }
    if let Some(rotation) = quick_rotation(s).and_then(|rotation| newton(s, rotation, EXACT_RAD)) {
        return rotation;
    }
    let rotation = best_rotation(&s.transpose());
    // If the maximum is not unique, Newton's method cannot do better and is not tried again.
    newton(s, rotation, EXACT_RAD).unwrap_or(rotation)
}

/// Ends with the first step that turns by less than `last_rad`.
#[inline]
fn newton(s: &DMat3, start: DQuat, last_rad: f64) -> Option<DQuat> {
    let mut rotation = start;
    for _ in 0..STEPS {
        let r = DMat3::from_quat(rotation);
        let b = r.transpose() * *s;
        let (x, y, z) = (b.x_axis, b.y_axis, b.z_axis);
        let skew = DVec3::new(y.z - z.y, z.x - x.z, x.y - y.x);
        let trace = x.x + y.y + z.z;
        // H's entries; its trace is twice B's.
        let open = OPEN * trace;
        let (hxx, hyy, hzz) = (y.y + z.z + open, x.x + z.z + open, x.x + y.y + open);
        let (hxy, hxz, hyz) = (-0.5 * (y.x + x.y), -0.5 * (z.x + x.z), -0.5 * (z.y + y.z));
        // H = L D Lᵀ.
        let (i1, lxy, lxz) = (hxx.recip(), hxy / hxx, hxz / hxx);
        let d2 = hyy - lxy * hxy;
        let m = hyz - lxy * hxz;
        let lyz = m / d2;
        let d3 = hzz - lxz * hxz - lyz * m;
        // This is also false for NaN.
        if !(trace > 0.0 && hxx > 0.0 && d2 > 0.0 && d3 > 0.0) {
            return None;
        }
        let residual = skew.abs().max_element();
        if residual <= STATIONARY * trace {
            return Some(rotation);
        }
        let u = skew.x;
        let v = skew.y - lxy * u;
        let w = (skew.z - lxz * u - lyz * v) / d3;
        let v = v / d2 - lyz * w;
        let turn = DVec3::new(u * i1 - lxy * v - lxz * w, v, w);
        if turn.is_nan() || turn.length_squared() >= 4.0 {
            return None;
        }
        // The unit quaternion of exp(turn), to second order.
        let step = DQuat::from_xyzw(0.5 * turn.x, 0.5 * turn.y, 0.5 * turn.z, 1.0);
        rotation = (rotation * step).normalize();
        if turn.length_squared() < last_rad * last_rad {
            return Some(rotation);
        }
    }
    None
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
pub(crate) mod tests {
    use super::fit;
    use glam::{DMat3, DQuat, DVec3};

    /// Singular values, the last one negative in a mirror.
    pub(crate) const STRETCHES: [DVec3; 5] = [
        DVec3::new(3.0, 2.0, 1.0),
        DVec3::new(1.0, 1.0, 0.0),
        DVec3::new(3.0, 1.0, -0.5),
        DVec3::splat(1e-9),
        DVec3::new(5e8, 1e8, -9e7),
    ];

    fn axis(i: u32) -> DVec3 {
        DVec3::new(
            f64::from(i * 7 % 11) - 5.0,
            f64::from(i * 5 % 13) - 6.0,
            f64::from(i % 7) - 2.5,
        )
        .normalize()
    }

    /// R diag(σ) Vᵀ for rotations R and V: its best rotation is R Vᵀ while each pair of σ has a positive sum.
    #[test]
    fn the_rotation_is_found_from_any_start_also_in_flat_and_reflected_cells() {
        for stretches in STRETCHES {
            for i in 0..60 {
                let rotation = DQuat::from_axis_angle(axis(i), 0.1 * f64::from(i));
                let v = DMat3::from_quat(DQuat::from_axis_angle(axis(i + 17), 2.0));
                let s = DMat3::from_quat(rotation) * v * DMat3::from_diagonal(stretches) * v.transpose();
                let start = DQuat::from_axis_angle(axis(i + 5), 0.3 * f64::from(i % 21));
                let error = 1.0 - fit(&s, start).dot(rotation).abs();
                assert!(error < 1e-12, "{stretches} {i}: {error:e}");
            }
        }
    }

    #[test]
    fn what_is_open_stays_as_it_was_and_nothing_is_not_finite() {
        let start = DQuat::from_axis_angle(axis(3), 1.0);
        assert_eq!(fit(&DMat3::ZERO, start), start);
        assert_eq!(fit(&DMat3::from_cols(DVec3::NAN, DVec3::X, DVec3::X), start), start);
        let line = DMat3::from_cols(DVec3::X, DVec3::ZERO, DVec3::ZERO);
        let twist = DQuat::from_rotation_x(0.7);
        assert!(fit(&line, twist).dot(twist).abs() > 1.0 - 1e-12);
        // A mirrored isotropic cell has no unique best rotation; any proper one is correct.
        assert!(fit(&(-DMat3::IDENTITY), start).is_normalized());
    }
}
