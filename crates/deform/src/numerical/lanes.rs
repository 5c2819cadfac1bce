//! Numbers of eight cells together.
//!
//! Matrices and quaternions are stored as numbers of eight cells each and computed in the machine's own vectors, as
//! many at a time as those hold. The code names the vectors, because the compiler splits arrays of eight into pairs and
//! single numbers. The loops have no closure, because a closure is not compiled for the caller's vectors. No operation
//! is fused and no lane sees another, so every machine and every grouping of cells gives the same bits.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use pulp::Simd;

/// The number of cells.
pub(crate) const LANES: usize = 8;

/// A number of each cell.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub(crate) struct Lanes(pub [f64; LANES]);

/// A machine's vector of numbers, one per cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vector<S: Simd> {
    pub(crate) simd: S,
    pub(crate) numbers: S::f64s,
}

/// Matrices, column by column.
pub(crate) type Matrices<S> = [[Vector<S>; 3]; 3];

macro_rules! lanewise {
    ($operation:ident, $name:ident, $intrinsic:ident) => {
        impl<S: Simd> $operation for Vector<S> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                let numbers = self.simd.$intrinsic(self.numbers, other.numbers);
                Self { numbers, ..self }
            }
        }
    };
}
lanewise!(Add, add, add_f64s);
lanewise!(Sub, sub, sub_f64s);
lanewise!(Mul, mul, mul_f64s);
lanewise!(Div, div, div_f64s);

impl<S: Simd> Neg for Vector<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            numbers: self.simd.neg_f64s(self.numbers),
            ..self
        }
    }
}

impl<S: Simd> Vector<S> {
    #[inline(always)]
    pub(crate) fn splat(simd: S, value: f64) -> Self {
        Self {
            simd,
            numbers: simd.splat_f64s(value),
        }
    }

    /// One entry of each matrix, as a vector.
    #[inline(always)]
    pub(crate) fn each<const N: usize>(simd: S, lanes: &[Lanes; N], place: usize) -> [Self; N] {
        let mut vectors = [Self::splat(simd, 0.0); N];
        for (vector, lanes) in vectors.iter_mut().zip(lanes) {
            vector.numbers = S::as_simd_f64s(&lanes.0).0[place];
        }
        vectors
    }

    #[inline(always)]
    pub(crate) fn put(self, lanes: &mut Lanes, place: usize) {
        S::as_mut_simd_f64s(&mut lanes.0).0[place] = self.numbers;
    }

    #[inline(always)]
    pub(crate) fn put_each<const N: usize>(vectors: [Self; N], lanes: &mut [Lanes; N], place: usize) {
        for (vector, lanes) in vectors.into_iter().zip(lanes) {
            vector.put(lanes, place);
        }
    }

    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        Self {
            numbers: self.simd.sqrt_f64s(self.numbers),
            ..self
        }
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        Self {
            numbers: self.simd.abs_f64s(self.numbers),
            ..self
        }
    }

    #[inline(always)]
    pub(super) fn max(self, other: Self) -> Self {
        self.or(other.less(self), other)
    }

    /// Its own numbers where `mask` is set, otherwise the other's.
    #[inline(always)]
    pub(crate) fn or(self, mask: Mask<S>, other: Self) -> Self {
        Self {
            numbers: self.simd.select_f64s(mask.lanes, self.numbers, other.numbers),
            ..self
        }
    }

    /// True in each lane that is less; false if either is NaN.
    #[inline(always)]
    pub(crate) fn less(self, other: Self) -> Mask<S> {
        Mask {
            simd: self.simd,
            lanes: self.simd.less_than_f64s(self.numbers, other.numbers),
        }
    }
}

/// A mask of a vector's cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mask<S: Simd> {
    pub(crate) simd: S,
    lanes: S::m64s,
}

impl<S: Simd> Mask<S> {
    /// The empty mask.
    #[inline(always)]
    pub(super) fn none(simd: S) -> Self {
        let one = Vector::splat(simd, 1.0);
        one.less(one)
    }

    #[inline(always)]
    pub(crate) fn is_full(self) -> bool {
        self.simd.first_true_m64s((!self).lanes) >= S::F64_LANES
    }
}

impl<S: Simd> BitAnd for Mask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self {
            lanes: self.simd.and_m64s(self.lanes, other.lanes),
            ..self
        }
    }
}

impl<S: Simd> BitOr for Mask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self {
            lanes: self.simd.or_m64s(self.lanes, other.lanes),
            ..self
        }
    }
}

impl<S: Simd> Not for Mask<S> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        let full = Vector::splat(self.simd, 0.0).less(Vector::splat(self.simd, 1.0));
        Self {
            lanes: self.simd.xor_m64s(self.lanes, full.lanes),
            ..self
        }
    }
}
