//! The sums over a vertex' neighbours to which its transformation is fitted.

use glam::{DMat3, DQuat, DVec3};

/// Sums over the edges e from a vertex, which displacements change by D.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    /// Σ D eᵀ.
    pub change: DMat3,
    /// Σ D.
    pub shift: DVec3,
    /// Σ e eᵀ: xx, xy, xz, yy, yz, zz.
    pub rest: [f64; 6],
}

impl Moments {
    /// The sums over no edges.
    pub const ZERO: Self = Self {
        change: DMat3::ZERO,
        shift: DVec3::ZERO,
        rest: [0.0; 6],
    };

    /// The sums over the edges from `local` to `others` at these rest positions, displaced by `d`.
    #[inline(always)]
    pub fn of(local: usize, others: &[u32], rest: &[DVec3], d: &[[f64; 3]]) -> Self {
        let (own, own_shift) = (rest[local], DVec3::from_array(d[local]));
        let mut moments = Self::ZERO;
        for &other in others {
            let edge = rest[other as usize] - own;
            let change = DVec3::from_array(d[other as usize]) - own_shift;
            moments.shift += change;
            moments.change += DMat3::from_cols(change * edge.x, change * edge.y, change * edge.z);
            let [xx, xy, xz, yy, yz, zz] = &mut moments.rest;
            *xx += edge.x * edge.x;
            *xy += edge.x * edge.y;
            *xz += edge.x * edge.z;
            *yy += edge.y * edge.y;
            *yz += edge.y * edge.z;
            *zz += edge.z * edge.z;
        }
        moments
    }

    /// Σ e · D.
    #[inline(always)]
    pub fn along(&self) -> f64 {
        self.change.x_axis.x + self.change.y_axis.y + self.change.z_axis.z
    }

    /// Σ e × D.
    #[inline(always)]
    pub fn across(&self) -> DVec3 {
        let DMat3 { x_axis, y_axis, z_axis } = self.change;
        DVec3::new(y_axis.z - z_axis.y, z_axis.x - x_axis.z, x_axis.y - y_axis.x)
    }

    /// tr((R − 1)ᵀ S) of a rotation R, S = Σ (e + D) eᵀ: larger if R fits the edges' motion better.
    #[inline(always)]
    pub fn alignment(&self, rotation: DQuat) -> f64 {
        let [xx, xy, xz, yy, yz, zz] = self.rest;
        let rest = DMat3::from_cols(DVec3::new(xx, xy, xz), DVec3::new(xy, yy, yz), DVec3::new(xz, yz, zz));
        let v = rotation.xyz();
        let bent = v.dot((self.change + rest) * v) - v.length_squared() * (self.along() + self.square());
        2.0 * (rotation.w * v.dot(self.across()) + bent)
    }

    /// Σ |e|².
    #[inline(always)]
    pub fn square(&self) -> f64 {
        self.rest[0] + self.rest[3] + self.rest[5]
    }
}
