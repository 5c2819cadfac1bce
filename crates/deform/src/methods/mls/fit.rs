//! The fit at one place, and its derivative.
//!
//! With a handle's displacement u(x) = L x + s, its moments w, v = Σ w r and Q = Σ w r rᵀ about the place p, the mean
//! c = Σ v of all points and their covariance K = Σ Q − c cᵀ, the displacements have the mean and the covariance
//!
//! u* = Σ (w u(p) + L v),   D = Σ (u(p) vᵀ + L Q) − u* cᵀ,
//!
//! and p is displaced by u* − N c: N = D K⁻¹ for affine maps [SMW06, equation 5], which have a field of their own
//! ([`super::affine`]), N = R − I for rigid ones, R the rotation next to S = K + D (its polar factor), and N = μ R − I with
//! μ = tr(Rᵀ S) / tr K for similarities.
//!
//! Derivatives: Rᵀ ∂R = [ω]× with (tr(P) I − P) ω = axial(Rᵀ ∂S), P = Rᵀ S.

use glam::{DMat3, DQuat, DVec3};

use super::moments::{Entry, first, second};
use crate::handles::{Handle, Motion};
use crate::numerical::rotation::fit;
use crate::space::hand_field::outer;
use crate::space::unit::Unit;

/// A handle's displacements in the unit of all points: u(x) = linear x + shift.
#[derive(Clone, Copy, Debug)]
pub(super) struct Displacing {
    pub linear: DMat3,
    pub shift: DVec3,
}

impl Displacing {
    /// From a motion in the handle's own coordinates; `origin` is `(unit.world_origin − handle.world_centre)` over the
    /// handle's radius.
    pub fn of(motion: &Motion, origin: DVec3, radius: f64, unit: &Unit) -> Self {
        Self {
            linear: motion.linear * radius.recip(),
            shift: (motion.shift + motion.linear * origin) / unit.length,
        }
    }

    fn at(&self, place: DVec3) -> DVec3 {
        self.linear * place + self.shift
    }
}

/// The data of a handle for [`Displacing::of`].
pub(super) fn origin(handle: &Handle, unit: &Unit) -> DVec3 {
    (unit.world_origin - handle.world_centre) / handle.radius
}

/// The moments of points and displacements at a place.
struct Sums {
    c: DVec3,
    k: DMat3,
    mean: DVec3,
    d: DMat3,
}

/// The map fitted at each place.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Turning {
    Similarity,
    Rigid,
}

/// N and the data for its derivative.
struct Fit {
    n: DMat3,
    rotation: DMat3,
    scale: f64,
    p: DMat3,
    k_trace: f64,
}

/// The displacement of a place, in the unit of all points. `entries` has the sum of all sets, then each handle's.
pub(super) fn displacement(turning: Turning, place: DVec3, entries: &[Entry], handles: &[Displacing]) -> DVec3 {
    let sums = sums(place, entries, handles);
    let Fit { n, .. } = fitted(turning, &sums);
    sums.mean - n * sums.c
}

/// The Jacobian of [`displacement`].
pub(super) fn jacobian(turning: Turning, place: DVec3, entries: &[Entry], handles: &[Displacing]) -> DMat3 {
    let sums = sums(place, entries, handles);
    let fit = fitted(turning, &sums);
    let columns = [0, 1, 2].map(|axis| {
        let slopes = slopes(axis, place, entries, handles, &sums);
        slopes.mean - n_slope(turning, &fit, &slopes) * sums.c - fit.n * slopes.c
    });
    DMat3::from_cols_array_2d(&columns.map(|column| column.to_array()))
}

fn sums(place: DVec3, entries: &[Entry], handles: &[Displacing]) -> Sums {
    let c = first(&entries[0].moments);
    let mut mean = DVec3::ZERO;
    let mut d = DMat3::ZERO;
    for (Entry { moments, .. }, handle) in entries[1..].iter().zip(handles) {
        let (at, v) = (handle.at(place), first(moments));
        mean += at * moments[0] + handle.linear * v;
        d += outer(at, v) + handle.linear * second(moments);
    }
    Sums {
        c,
        k: second(&entries[0].moments) - outer(c, c),
        mean,
        d: d - outer(mean, c),
    }
}

/// The derivative of [`sums`] along an axis.
fn slopes(axis: usize, place: DVec3, entries: &[Entry], handles: &[Displacing], sums: &Sums) -> Sums {
    let slope = |entry: &Entry| entry.slopes[axis].map(f64::from);
    let total = slope(&entries[0]);
    let c = first(&total);
    let mut mean = DVec3::ZERO;
    let mut d = DMat3::ZERO;
    for (entry, handle) in entries[1..].iter().zip(handles) {
        let (own, change) = (&entry.moments, slope(entry));
        let (at, along) = (handle.at(place), handle.linear.col(axis));
        mean += at * change[0] + along * own[0] + handle.linear * first(&change);
        d += outer(along, first(own)) + outer(at, first(&change)) + handle.linear * second(&change);
    }
    Sums {
        c,
        k: second(&total) - outer(c, sums.c) - outer(sums.c, c),
        mean,
        d: d - outer(mean, sums.c) - outer(sums.mean, c),
    }
}

fn fitted(turning: Turning, sums: &Sums) -> Fit {
    let s = sums.k + sums.d;
    // The first fit ends as soon as the next step would be small.
    let rotation = DMat3::from_quat(fit(&s, fit(&s, DQuat::IDENTITY)));
    let p = rotation.transpose() * s;
    let k_trace = trace(&sums.k);
    let scale = match turning {
        Turning::Similarity => trace(&p) / k_trace,
        Turning::Rigid => 1.0,
    };
    Fit {
        n: rotation * scale - DMat3::IDENTITY,
        rotation,
        scale,
        p,
        k_trace,
    }
}

/// ∂N.
fn n_slope(turning: Turning, fit: &Fit, slopes: &Sums) -> DMat3 {
    let Fit { rotation, scale, .. } = fit;
    let m = rotation.transpose() * (slopes.k + slopes.d);
    let axial = DVec3::new(
        m.y_axis.z - m.z_axis.y,
        m.z_axis.x - m.x_axis.z,
        m.x_axis.y - m.y_axis.x,
    );
    let h = DMat3::from_diagonal(DVec3::splat(trace(&fit.p))) - fit.p;
    let turn = h.inverse() * axial;
    // A rotation that is not unique has no derivative.
    let turn = if turn.is_finite() { turn } else { DVec3::ZERO };
    let turned =
        *rotation * DMat3::from_cols(turn.cross(DVec3::X), turn.cross(DVec3::Y), turn.cross(DVec3::Z)) * *scale;
    match turning {
        Turning::Similarity => turned + *rotation * ((trace(&m) - scale * trace(&slopes.k)) / fit.k_trace),
        Turning::Rigid => turned,
    }
}

fn trace(m: &DMat3) -> f64 {
    m.x_axis.x + m.y_axis.y + m.z_axis.z
}
