//! A value between places that have one.

use glam::{DMat3, DVec3};

/// The part of the places' spread that a slope needs: places on a plane give none across it.
const LEAST_SPREAD: f64 = 1e-3;

/// The value at a point between places, the nearest first, each with its way from the point and its value; a place within
/// `here` gives its own value.
///
/// It is the value of the linear function that fits best, with the weights ((r − d)/(r d))² of Franke and Nielson [FN80],
/// in which d is a place's distance and r the farthest one's. So linear fields are reproduced nearly, each place has its
/// own value, and a place that enters or leaves the list changes nothing. The result lies between the places' least and
/// largest values.
pub(super) fn blended(near: impl Iterator<Item = (DVec3, DVec3)> + Clone, here: f64) -> DVec3 {
    let Some((first_way, first)) = near.clone().next() else {
        return DVec3::ZERO;
    };
    if first_way.length() <= here || near.clone().all(|(_, value)| value == first) {
        return first;
    }
    let reach = near.clone().map(|(way, _)| way.length()).fold(0.0, f64::max) * (1.0 + 1e-6);
    let (mut least, mut most) = (first, first);
    let (mut weights, mut ways, mut values) = (0.0, DVec3::ZERO, DVec3::ZERO);
    let (mut spread, mut slopes) = (DMat3::ZERO, DMat3::ZERO);
    for (way, value) in near {
        (least, most) = (least.min(value), most.max(value));
        let distance = way.length().max(f64::MIN_POSITIVE);
        let weight = ((reach - distance) / distance).powi(2);
        weights += weight;
        ways += weight * way;
        values += weight * value;
        spread += columns(weight * way, way);
        slopes += columns(weight * value, way);
    }
    let (mean_way, mean) = (ways / weights, values / weights);
    // Both about their means.
    let spread = spread - columns(mean_way * weights, mean_way);
    let slopes = slopes - columns(mean * weights, mean_way);
    let trace = spread.x_axis.x + spread.y_axis.y + spread.z_axis.z;
    let spread = spread + DMat3::from_diagonal(DVec3::splat(LEAST_SPREAD * trace));
    let fitted = match trace > 0.0 {
        true => mean - slopes * (spread.inverse() * mean_way),
        false => mean,
    };
    let fitted = if fitted.is_finite() { fitted } else { mean };
    fitted.clamp(least, most)
}

/// a bᵀ.
fn columns(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
