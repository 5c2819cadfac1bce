//! A row of three right-hand sides, in single or double precision.

use std::ops::{Add, Mul, Sub};

/// A precision for solving.
pub(crate) trait Real:
    Copy + Default + Send + Sync + std::fmt::Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + 'static
{
    /// The number rounded to it.
    fn of(value: f64) -> Self;
    /// The same number.
    fn wide(self) -> f64;
}

impl Real for f32 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value as Self
    }
    #[inline(always)]
    fn wide(self) -> f64 {
        f64::from(self)
    }
}

impl Real for f64 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn wide(self) -> f64 {
        self
    }
}

/// One row of three right-hand sides: x, y, z and a zero.
pub(crate) type Rhs<T> = [T; 4];

#[inline(always)]
pub(super) fn plus<T: Real>(a: Rhs<T>, b: Rhs<T>) -> Rhs<T> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]]
}

#[inline(always)]
pub(super) fn minus<T: Real>(a: Rhs<T>, b: Rhs<T>) -> Rhs<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
}

#[inline(always)]
pub(super) fn times<T: Real>(a: Rhs<T>, factor: T) -> Rhs<T> {
    [a[0] * factor, a[1] * factor, a[2] * factor, a[3] * factor]
}
