//! Three numbers with the few operations the generator needs.
//!
//! Only `+ - * /` and the square root are used, here and in the shapes: IEEE 754 fixes their every bit, so the samples
//! come out the same on every machine, which no platform's `sin` or `exp` promises.

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

/// Short for the three numbers as a vector.
pub const fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3 { x, y, z }
}

impl Vec3 {
    /// The inner product.
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// The vector product, right-handed.
    pub fn cross(self, other: Self) -> Self {
        v(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// The Euclidean length.
    pub fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// The direction, or zero for a vector without one.
    pub fn normalized(self) -> Self {
        let length = self.length();
        if length > 0.0 {
            self * (1.0 / length)
        } else {
            Self::default()
        }
    }

    /// The point a share `t` of the way to `other`.
    pub fn lerp(self, other: Self, t: f64) -> Self {
        self * (1.0 - t) + other * t
    }

    /// Each component divided by that of `other`.
    pub fn over(self, other: Self) -> Self {
        v(self.x / other.x, self.y / other.y, self.z / other.z)
    }

    /// The point with x positive: a shape symmetric left and right is modelled on one side only.
    pub fn mirrored(self) -> Self {
        v(self.x.abs(), self.y, self.z)
    }

    /// The three numbers in order.
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
