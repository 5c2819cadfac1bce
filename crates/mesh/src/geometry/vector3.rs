//! Vectors of three coordinates, in either precision.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Sub};

use glam::{DVec3, Vec3A};

/// Vectors whose lengths are computed together, by loops compiled for the machine's vectors.
pub(crate) const BLOCK: usize = 64;

/// [`DVec3`], or [`Vec3A`] in single precision.
pub trait Vector3: Copy + Send + Sync + Add<Output = Self> + Sub<Output = Self> + AddAssign + Sum {
    /// The zero vector.
    const ZERO: Self;

    /// This vector, rounded to the precision.
    fn rounded(vector: DVec3) -> Self;

    /// This vector in single precision.
    fn single(self) -> Vec3A;

    /// Perpendicular to both; its length is the area of the parallelogram that they span.
    #[must_use]
    fn cross(self, other: Self) -> Self;

    /// Scales each to length one, or to zero if the inverse of its length is not finite.
    fn normalize_all(vectors: &mut [Self]);
}

macro_rules! vector {
    ($vector:ty, $number:ty, $rounded:expr, $single:expr) => {
        impl Vector3 for $vector {
            const ZERO: Self = <$vector>::ZERO;

            #[inline(always)]
            fn rounded(vector: DVec3) -> Self {
                $rounded(vector)
            }

            #[inline(always)]
            fn single(self) -> Vec3A {
                $single(self)
            }

            #[inline(always)]
            fn cross(self, other: Self) -> Self {
                <$vector>::cross(self, other)
            }

            #[inline(always)]
            fn normalize_all(vectors: &mut [Self]) {
                let mut shrink: [$number; BLOCK] = [0.0; BLOCK];
                for vectors in vectors.chunks_mut(BLOCK) {
                    for (shrink, vector) in shrink.iter_mut().zip(&*vectors) {
                        *shrink = vector.x * vector.x + vector.y * vector.y + vector.z * vector.z;
                    }
                    for shrink in &mut shrink {
                        let inverse = 1.0 / shrink.sqrt();
                        *shrink = if inverse.is_finite() { inverse } else { 0.0 };
                    }
                    for (vector, shrink) in vectors.iter_mut().zip(shrink) {
                        *vector = match shrink {
                            0.0 => <$vector>::ZERO,
                            shrink => *vector * shrink,
                        };
                    }
                }
            }
        }
    };
}

vector!(DVec3, f64, |vector| vector, |vector: DVec3| vector.as_vec3a());
vector!(Vec3A, f32, |vector: DVec3| vector.as_vec3a(), |vector| vector);
