//! The moments of the weighted points about a place, and their slopes.

use glam::{DMat3, DVec3};

use super::points::{Points, Set};

/// η: the reach of the cloud around each sample, in the unit of all points.
pub(super) const CLOUD: f64 = 0.02;

/// Σ w [1, r, r rᵀ] over weighted points at r from the place: the weight; x, y, z; xx, yy, zz, xy, xz, yz.
pub(super) type Moments = [f64; 10];

/// Their slopes along x, y and z.
pub(super) type Slopes<T> = [[T; 10]; 3];

/// A set's moments at a place, with their slopes; stored in single precision, because only normals are made of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<T = f32> {
    pub moments: Moments,
    pub slopes: Slopes<T>,
}

/// The moments at a place: for all sets together, and for each. All weights sum to 1.
pub(super) struct PlaceMoments {
    pub total: Entry<f64>,
    pub sets: Vec<Entry<f64>>,
}

impl<T: Copy + Default> Default for Entry<T> {
    fn default() -> Self {
        Self {
            moments: Moments::default(),
            slopes: Slopes::default(),
        }
    }
}

impl Entry<f64> {
    /// The stored form.
    pub fn stored(&self) -> Entry {
        Entry {
            moments: self.moments,
            slopes: self.slopes.map(|row| row.map(|slope| slope as f32)),
        }
    }
}

/// The moments at a point.
pub(super) fn moments_at(points: &Points, half_falloff: f64, positions: &[DVec3], world_point: DVec3) -> PlaceMoments {
    let place = points.unit.local(world_point);
    // A set's weight less its normalisation, and its logarithm's slope.
    let weight = |set: &Set| {
        let to_nearest = set.to_nearest(world_point, positions, &points.unit);
        let square = to_nearest.length_squared() + set.softening;
        (power(square, half_falloff), to_nearest * (2.0 * half_falloff / square))
    };
    let weights: Vec<(f64, DVec3)> = points.sets.iter().map(weight).collect();
    let sum: f64 = weights.iter().map(|(weight, _)| weight).sum();
    let mean_slope: DVec3 = weights.iter().map(|(weight, slope)| *slope * (weight / sum)).sum();
    let mut total = Entry::default();
    let own = points.sets.iter().zip(&weights).map(|(set, (weight, slope))| {
        let weight = weight / sum;
        let slope = *slope - mean_slope;
        let (mut moments, mut slopes) = shared(set, half_falloff, place);
        for k in 0..10 {
            moments[k] *= weight;
            total.moments[k] += moments[k];
            for axis in 0..3 {
                slopes[axis][k] = slopes[axis][k] * weight + slope[axis] * moments[k];
                total.slopes[axis][k] += slopes[axis][k];
            }
        }
        Entry { moments, slopes }
    });
    let sets = own.collect();
    PlaceMoments { total, sets }
}

/// The moments of one set, whose samples' weights sum to 1, and their slopes.
fn shared(set: &Set, half_falloff: f64, place: DVec3) -> (Moments, Slopes<f64>) {
    let (mut sums, mut slopes) = ([0.0; 10], [[0.0; 10]; 3]);
    for sample in &set.samples {
        let r = *sample - place;
        let square = r.length_squared() + set.softening;
        let weight = power(square, half_falloff);
        let slope = r * (2.0 * half_falloff / square);
        let own = [
            1.0,
            r.x,
            r.y,
            r.z,
            r.x * r.x,
            r.y * r.y,
            r.z * r.z,
            r.x * r.y,
            r.x * r.z,
            r.y * r.z,
        ]
        .map(|term| term * weight);
        for k in 0..10 {
            sums[k] += own[k];
            slopes[0][k] += own[k] * slope.x;
            slopes[1][k] += own[k] * slope.y;
            slopes[2][k] += own[k] * slope.z;
        }
    }
    let inverse = sums[0].recip();
    let moments = sums.map(|sum| sum * inverse);
    let [_, x, y, z, ..] = moments;
    for (axis, slopes) in slopes.iter_mut().enumerate() {
        let mean_slope = slopes[0] * inverse;
        for k in 0..10 {
            slopes[k] = slopes[k] * inverse - mean_slope * moments[k];
        }
        // The points stay while the place moves: r changes by −1 along the axis.
        let from_place: [f64; 9] = match axis {
            0 => [1.0, 0.0, 0.0, 2.0 * x, 0.0, 0.0, y, z, 0.0],
            1 => [0.0, 1.0, 0.0, 0.0, 2.0 * y, 0.0, x, 0.0, z],
            _ => [0.0, 0.0, 1.0, 0.0, 0.0, 2.0 * z, 0.0, x, y],
        };
        for (slope, change) in slopes[1..].iter_mut().zip(from_place) {
            *slope -= change;
        }
    }
    let mut moments = moments;
    for second in &mut moments[4..7] {
        *second += CLOUD * CLOUD;
    }
    (moments, slopes)
}

/// One over this power of a squared distance.
fn power(square: f64, half_falloff: f64) -> f64 {
    if half_falloff == half_falloff.round() {
        square.powi(-(half_falloff as i32))
    } else {
        square.powf(-half_falloff)
    }
}

/// Σ w r.
pub(super) fn first(moments: &Moments) -> DVec3 {
    DVec3::new(moments[1], moments[2], moments[3])
}

/// Σ w r rᵀ.
pub(super) fn second(moments: &Moments) -> DMat3 {
    let [.., xx, yy, zz, xy, xz, yz] = *moments;
    DMat3::from_cols(DVec3::new(xx, xy, xz), DVec3::new(xy, yy, yz), DVec3::new(xz, yz, zz))
}
