//! Similarities that are linear in the displacements of a vertex' neighbours [SCL+04, equation 5; BS08, equation 27].
//!
//! T = (1 + s) I + [h]× and a translation fit vertex i and its n neighbours best in the least-squares sense. With the
//! edges e_j, D_j = d_j − d_i and c_j = e_j − Σ e / (n + 1), the edges from the ring's middle, i being one of it,
//!
//! s = Σ c_j · D_j / Σ |c|²,  h = J⁻¹ Σ c_j × D_j,  J = Σ |c|² I − c cᵀ,
//!
//! since s c and h × c are orthogonal; Σ |c|² and J are over all of the ring. If it is on one line, the turn about that
//! line is 0.

use glam::{DMat3, DQuat, DVec3};

use super::moments::Moments;

/// J is at least this share of its trace, so that edges on one line leave no turn open.
const OPEN: f64 = 1e-9;

/// The fit at one vertex.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Similarity {
    /// Σ e / (n + 1).
    middle: DVec3,
    /// 1 / Σ |c|², or 0.
    inverse_square: f64,
    /// J⁻¹.
    inverse_inertia: DMat3,
}

/// s and h.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Fitted {
    pub scale: f64,
    pub turn: DVec3,
}

impl Similarity {
    /// The fit for the rest edges of a vertex.
    pub fn of(edges: impl Iterator<Item = DVec3>) -> Self {
        let (mut square, mut outer) = (0.0, DMat3::ZERO);
        let (mut sum, mut count) = (DVec3::ZERO, 1.0);
        for edge in edges {
            square += edge.length_squared();
            outer += squared(edge);
            sum += edge;
            count += 1.0;
        }
        let middle = sum / count;
        square -= middle.dot(sum);
        outer -= squared(middle) * count;
        // Also if it is NaN, or so small that its inverse is not finite.
        if square.is_nan() || square < 1e-300 {
            return Self::default();
        }
        let inertia = DMat3::from_diagonal(DVec3::splat(square * (1.0 + OPEN))) - outer;
        Self {
            middle,
            inverse_square: square.recip(),
            inverse_inertia: inertia.inverse(),
        }
    }

    /// The same with s = 0.
    ///
    /// At a free border L p also has a part within the surface, across the border. Under similarities it only requires
    /// that the border keeps its angles, and on flat parts every conformal map would be free; without the scale the
    /// width of flat parts is kept too.
    #[must_use]
    pub fn without_scale(self) -> Self {
        Self {
            inverse_square: 0.0,
            ..self
        }
    }

    /// The fit to displacements with these moments.
    #[inline(always)]
    pub fn fit(&self, moments: &Moments) -> Fitted {
        Fitted {
            scale: (moments.along() - self.middle.dot(moments.shift)) * self.inverse_square,
            turn: self.inverse_inertia * (moments.across() - self.middle.cross(moments.shift)),
        }
    }

    /// The matrix that maps D at the edge e to its part of (T − I) v.
    pub fn effect_on(&self, v: DVec3, edge: DVec3) -> DMat3 {
        let cross = |a: DVec3| DMat3::from_cols(a.cross(DVec3::X), a.cross(DVec3::Y), a.cross(DVec3::Z));
        let edge = edge - self.middle;
        let along = edge * self.inverse_square;
        let scaled = DMat3::from_cols(v * along.x, v * along.y, v * along.z);
        scaled - cross(v) * self.inverse_inertia * cross(edge)
    }
}

/// v vᵀ.
fn squared(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

impl Fitted {
    /// A guess at the rotation of the edges. For a flat ring that turns by θ about an axis in its plane the fit has |h|
    /// = sin θ and 1 + s = (1 + cos θ) / 2, which is 2 tan(θ/2) as a quotient, and less than tan θ.
    pub fn rotation_guess(&self) -> DQuat {
        let q = DQuat::from_xyzw(self.turn.x, self.turn.y, self.turn.z, 2.0 * (1.0 + self.scale));
        let square = q.length_squared();
        if square.is_finite() && square > 0.0 {
            q * square.sqrt().recip()
        } else {
            DQuat::IDENTITY
        }
    }

    /// T − I.
    pub fn change(&self) -> DMat3 {
        let h = self.turn;
        DMat3::from_cols(h.cross(DVec3::X), h.cross(DVec3::Y), h.cross(DVec3::Z))
            + DMat3::from_diagonal(DVec3::splat(self.scale))
    }
}
