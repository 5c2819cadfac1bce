//! A 3D vector with the few operations that the generator needs.
//!
//! This code and the shapes use only `+ - * /` and square roots: IEEE 754 defines their results exactly, so the samples
//! are equal on every machine, which is not guaranteed for `sin` or `exp`.

use std::ops::{Add, AddAssign, Mul, Neg, Sub};

/// A point or direction in world space (y up, z towards the viewer, as in glTF).
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Vec3 {
    /// To the right, seen from the front.
    pub x: f64,
    /// Up.
    pub y: f64,
    /// To the front.
    pub z: f64,
}

/// Shorthand for a vector.
pub const fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3 { x, y, z }
}

impl Vec3 {
    /// Dot product.
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Cross product, right-handed.
    pub fn cross(self, other: Self) -> Self {
        v(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// Euclidean length.
    pub fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// The unit vector, or zero for the zero vector.
    pub fn normalized(self) -> Self {
        let length = self.length();
        if length > 0.0 {
            self * (1.0 / length)
        } else {
            Self::default()
        }
    }

    /// Linear interpolation towards `other`.
    pub fn lerp(self, other: Self, t: f64) -> Self {
        self * (1.0 - t) + other * t
    }

    /// Componentwise quotient.
    pub fn over(self, other: Self) -> Self {
        v(self.x / other.x, self.y / other.y, self.z / other.z)
    }

    /// The point mirrored to x ≥ 0, for shapes that are modelled on one side only.
    pub fn mirrored(self) -> Self {
        v(self.x.abs(), self.y, self.z)
    }

    /// The components.
    pub fn array(self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }
}

impl Add for Vec3 {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        v(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl AddAssign for Vec3 {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Vec3 {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        v(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl Mul<f64> for Vec3 {
    type Output = Self;
    fn mul(self, scale: f64) -> Self {
        v(self.x * scale, self.y * scale, self.z * scale)
    }
}

impl Neg for Vec3 {
    type Output = Self;
    fn neg(self) -> Self {
        v(-self.x, -self.y, -self.z)
    }
}
