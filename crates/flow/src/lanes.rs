//! Many numbers at a time, for loops that are compiled for the processor's vectors.

use glam::DVec2;

use crate::plane::{SMALL, rotation_by_series, small_rotation, turned};

/// The numbers that are treated at a time.
pub(crate) const LANES: usize = 64;

/// A number for each of several vertices.
pub(crate) type Lanes = [f64; LANES];

/// A vector of the plane for each of several vertices: their x, then their y.
pub(crate) type Vectors = [Lanes; 2];

/// The vector at a place.
#[inline(always)]
pub(crate) fn vector(vectors: &Vectors, i: usize) -> DVec2 {
    DVec2::new(vectors[0][i], vectors[1][i])
}

/// Puts a vector to a place.
#[inline(always)]
pub(crate) fn put(vectors: &mut Vectors, i: usize, vector: DVec2) {
    (vectors[0][i], vectors[1][i]) = (vector.x, vector.y);
}

/// Makes each vector one that is computed from it and its place.
#[inline(always)]
pub(crate) fn change(vectors: &mut Vectors, change: impl Fn(usize, DVec2) -> DVec2) {
    let [xs, ys] = vectors;
    for (i, (x, y)) in xs.iter_mut().zip(ys).enumerate() {
        let changed = change(i, DVec2::new(*x, *y));
        (*x, *y) = (changed.x, changed.y);
    }
}

/// Turns each vector by a further angle, which mostly is small.
#[inline(always)]
pub(crate) fn turn(vectors: &mut Vectors, angles: &Lanes) {
    let large = angles.iter().map(|angle| u64::from(angle.abs() > SMALL)).sum::<u64>();
    if large == 0 {
        change(vectors, |i, vector| turned(rotation_by_series(angles[i]), vector));
        return;
    }
    for (i, &angle) in angles.iter().enumerate() {
        put(vectors, i, turned(small_rotation(angle), vector(vectors, i)));
    }
}
