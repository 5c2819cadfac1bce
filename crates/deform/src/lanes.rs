//! Eight numbers side by side, and eight cells' rotations fitted at once.
//!
//! Plain arrays and loops: inside [`pulp::Arch::dispatch`] the compiler makes vectors of them, as wide as the machine
//! has, elsewhere pairs. No operation is fused or reordered, and no lane sees another, so every machine and every
//! grouping of cells gives the same bits.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::rotation::{OPEN, SMALL_RAD, STATIONARY, STEPS};

/// How many lanes there are.
pub(crate) const LANES: usize = 8;

/// Eight numbers.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub(crate) struct Lanes(pub [f64; LANES]);

macro_rules! lanewise {
    ($operation:ident, $name:ident, $symbol:tt) => {
        impl $operation for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $name(mut self, other: Self) -> Self {
                for k in 0..LANES {
                    self.0[k] $symbol other.0[k];
                }
                self
            }
        }
    };
}
lanewise!(Add, add, +=);
lanewise!(Sub, sub, -=);
lanewise!(Mul, mul, *=);
lanewise!(Div, div, /=);

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for k in 0..LANES {
            self.0[k] = -self.0[k];
        }
        self
    }
}

impl Lanes {
    /// One number in all lanes.
    #[inline(always)]
    pub fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn sqrt(mut self) -> Self {
        for k in 0..LANES {
            self.0[k] = self.0[k].sqrt();
        }
        self
    }

    #[inline(always)]
    fn max(mut self, other: Self) -> Self {
        for k in 0..LANES {
            self.0[k] = if self.0[k] > other.0[k] { self.0[k] } else { other.0[k] };
        }
        self
    }

    /// Its own lanes where `mask` is set, else the other's.
    #[inline(always)]
    fn or(mut self, mask: Mask, other: Self) -> Self {
        for k in 0..LANES {
            self.0[k] = if mask[k] { self.0[k] } else { other.0[k] };
        }
        self
    }

    #[inline(always)]
    fn less(self, other: Self) -> Mask {
        let mut mask = [false; LANES];
        for k in 0..LANES {
            mask[k] = self.0[k] < other.0[k];
        }
        mask
    }

    #[inline(always)]
    fn abs(mut self) -> Self {
        for k in 0..LANES {
            self.0[k] = self.0[k].abs();
        }
        self
    }
}

type Mask = [bool; LANES];

/// Eight quaternions: x, y, z, w.
pub(crate) type Quaternions = [Lanes; 4];

/// Eight matrices, column by column: `[column][row]`.
pub(crate) type Matrices = [[Lanes; 3]; 3];

/// The rotation matrices less the identity: near the identity they keep their digits.
#[inline(always)]
pub(crate) fn turns([x, y, z, w]: Quaternions) -> Matrices {
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (w * x2, w * y2, w * z2);
    [
        [-(yy + zz), xy + wz, xz - wy],
        [xy - wz, -(xx + zz), yz + wx],
        [xz + wy, yz - wx, -(xx + yy)],
    ]
}

/// Newton's method of [`crate::rotation`] in every lane at once: the rotations that maximise tr(Rᵀ S), from the guesses
/// `start`. Lanes marked false found none.
#[inline(always)]
pub(crate) fn fit(s: &Matrices, start: Quaternions) -> (Quaternions, Mask) {
    let mut rotation = start;
    let mut done = [false; LANES];
    let mut found = [true; LANES];
    let (zero, one, half) = (Lanes::splat(0.0), Lanes::splat(1.0), Lanes::splat(0.5));
    for _ in 0..STEPS {
        let mut r = turns(rotation);
        for k in 0..3 {
            r[k][k] = r[k][k] + one;
        }
        // b[c][k]: entry k, c of Rᵀ S.
        let b: Matrices =
            std::array::from_fn(|c| std::array::from_fn(|k| r[k][0] * s[c][0] + r[k][1] * s[c][1] + r[k][2] * s[c][2]));
        let skew = [b[1][2] - b[2][1], b[2][0] - b[0][2], b[0][1] - b[1][0]];
        let trace = b[0][0] + b[1][1] + b[2][2];
        let open = Lanes::splat(OPEN) * trace;
        let (hxx, hyy, hzz) = (
            b[1][1] + b[2][2] + open,
            b[0][0] + b[2][2] + open,
            b[0][0] + b[1][1] + open,
        );
        let minus_half = -half;
        let (hxy, hxz, hyz) = (
            minus_half * (b[1][0] + b[0][1]),
            minus_half * (b[2][0] + b[0][2]),
            minus_half * (b[2][1] + b[1][2]),
        );
        let i1 = one / hxx;
        let (lxy, lxz) = (hxy * i1, hxz * i1);
        let d2 = hyy - lxy * hxy;
        let m = hyz - lxy * hxz;
        let i2 = one / d2;
        let lyz = m * i2;
        let d3 = hzz - lxz * hxz - lyz * m;
        let u = skew[0];
        let v = skew[1] - lxy * u;
        let turn_z = (skew[2] - lxz * u - lyz * v) / d3;
        let turn_y = v * i2 - lyz * turn_z;
        let turn_x = u * i1 - lxy * turn_y - lxz * turn_z;
        let square = turn_x * turn_x + turn_y * turn_y + turn_z * turn_z;
        let residual = skew[0].abs().max(skew[1].abs()).max(skew[2].abs());
        // H positive definite and a sound turn; also false where anything is not a number.
        let positive = [zero.less(trace), zero.less(hxx), zero.less(d2), zero.less(d3)];
        let sound = square.less(Lanes::splat(4.0));
        let stationary = residual.less(Lanes::splat(STATIONARY) * trace);
        let small = square.less(Lanes::splat(SMALL_RAD * SMALL_RAD));
        let [qx, qy, qz, qw] = rotation;
        let (x, y, z) = (half * turn_x, half * turn_y, half * turn_z);
        let turned = [
            qx + qw * x + qy * z - qz * y,
            qy + qw * y + qz * x - qx * z,
            qz + qw * z + qx * y - qy * x,
            qw - qx * x - qy * y - qz * z,
        ];
        let norm = turned[0] * turned[0] + turned[1] * turned[1] + turned[2] * turned[2] + turned[3] * turned[3];
        let inverse = one / norm.sqrt();
        let mut keeps = [false; LANES];
        for k in 0..LANES {
            let definite = positive[0][k] & positive[1][k] & positive[2][k] & positive[3][k];
            let ends = definite & stationary[k];
            let fails = !done[k] & !ends & !(definite & sound[k]);
            keeps[k] = done[k] | ends | fails;
            found[k] &= !fails;
            done[k] = keeps[k] | small[k];
        }
        for k in 0..4 {
            rotation[k] = rotation[k].or(keeps, turned[k] * inverse);
        }
        if done == [true; LANES] {
            break;
        }
    }
    for k in 0..LANES {
        found[k] &= done[k];
    }
    (rotation, found)
}
