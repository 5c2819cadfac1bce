//! The curves through keys: cubic Hermite splines for numbers and vectors, squad for rotations.

use glam::{DMat3, DQuat, DVec3};

/// The rate at a key is at most this many times the slope to either neighbour. Where a number rises on both sides, its
/// curve then stays between the keys (Fritsch and Carlson's bound).
const MOST_RATE: f64 = 3.0;

/// The rates of change at a key between two others, per second: those of the parabola through the three (Catmull–Rom's
/// with uneven spacing), as far as [`MOST_RATE`] allows.
pub(super) struct KeyRates {
    /// The seconds from the key before, and to the key after.
    spans: [f64; 2],
    /// The weights of the steps from the key before and to the key after.
    weights: [f64; 2],
}

impl KeyRates {
    /// At the second of three ascending times.
    pub(super) fn of([before, own, after]: [f64; 3]) -> Self {
        let [first, second] = [own - before, after - own];
        Self {
            spans: [first, second],
            weights: [second / first, first / second].map(|weight| weight / (first + second)),
        }
    }

    /// The rate of a vector, in the direction of the parabola's.
    pub(super) fn of_vector(&self, before: DVec3, own: DVec3, after: DVec3) -> DVec3 {
        let (first, second) = (own - before, after - own);
        let rate = first * self.weights[0] + second * self.weights[1];
        rate * self.allowed(first.length(), second.length(), rate.length())
    }

    /// The rate of a matrix, measured by its Frobenius norm.
    pub(super) fn of_matrix(&self, before: DMat3, own: DMat3, after: DMat3) -> DMat3 {
        let (first, second) = (own - before, after - own);
        let rate = first * self.weights[0] + second * self.weights[1];
        rate * self.allowed(size(first), size(second), size(rate))
    }

    /// The rate of a number that never leaves the range of its neighbours: at the lowest and the highest key it is 0. A
    /// number that is none has the rate 0.
    pub(super) fn of_number(&self, before: f64, own: f64, after: f64) -> f64 {
        let (first, second) = (own - before, after - own);
        let rate = first * self.weights[0] + second * self.weights[1];
        match first * second > 0.0 && rate.is_finite() {
            true => rate * self.allowed(first.abs(), second.abs(), rate.abs()),
            false => 0.0,
        }
    }

    /// The share of a rate that the steps to both neighbours allow.
    fn allowed(&self, first: f64, second: f64, rate: f64) -> f64 {
        let most = MOST_RATE * (first / self.spans[0]).min(second / self.spans[1]);
        if rate > most { most / rate } else { 1.0 }
    }
}

/// The Frobenius norm.
fn size(matrix: DMat3) -> f64 {
    let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    columns.map(DVec3::length_squared).iter().sum::<f64>().sqrt()
}

/// A share of the way, with the speed 0 at an end that rests and 1 at one that does not.
pub(super) fn eased(share: f64, begins_at_rest: bool, ends_at_rest: bool) -> f64 {
    let [_, end, begin_rate, end_rate] = hermite(share);
    let rate = |rests: bool| if rests { 0.0 } else { 1.0 };
    end + rate(begins_at_rest) * begin_rate + rate(ends_at_rest) * end_rate
}

/// The values of the cubic Hermite polynomials: of both ends, and of the rates at both ends.
pub(super) fn hermite(share: f64) -> [f64; 4] {
    let (square, cube) = (share * share, share.powi(3));
    [
        2.0 * cube - 3.0 * square + 1.0,
        3.0 * square - 2.0 * cube,
        cube - 2.0 * square + share,
        cube - square,
    ]
}

/// Squad: slerp(slerp(q₀, q₁, h), slerp(s₀, s₁, h), 2h(1 − h)) \[Sho87\].
pub(super) fn squad([from, to]: [DQuat; 2], [inner_from, inner_to]: [DQuat; 2], share: f64) -> DQuat {
    let (outer, inner) = (from.slerp(to, share), inner_from.slerp(inner_to, share));
    outer.slerp(inner, 2.0 * share * (1.0 - share)).normalize()
}
