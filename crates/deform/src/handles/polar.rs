//! A handle's linear map as a rotation and a stretch, A = R S [SD92], and blends of several.
//!
//! The rotation is kept as its logarithm, the axis times the angle in radians, so that a weight scales the angle and a
//! turn by more than half a turn keeps its direction.

use std::f64::consts::TAU;

use glam::{DMat3, DQuat, DVec3};

use super::{Handle, Motion};
use crate::numerical::rotation::fit;

/// R = exp([turn_rad]×) and S = I + stretch.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Polar {
    /// Axis times angle, in radians.
    pub turn_rad: DVec3,
    /// The stretch less the identity.
    pub stretch: DMat3,
}

/// The weight of another handle's turn if two logarithms are equally near.
const BIAS: f64 = 1e-3;

impl Default for Polar {
    /// The parts of the identity.
    fn default() -> Self {
        Self {
            turn_rad: DVec3::ZERO,
            stretch: DMat3::ZERO,
        }
    }
}

impl Polar {
    /// The parts of a linear map, with a turn by at most π. For a singular map R is one of the best rotations; a mirror
    /// image stays in S.
    pub fn of(linear: &DMat3) -> Self {
        // The first fit ends as soon as the next step would be small.
        let rotation = fit(linear, fit(linear, DQuat::IDENTITY));
        let shortest = if rotation.w < 0.0 { -rotation } else { rotation };
        Self {
            turn_rad: shortest.to_scaled_axis(),
            stretch: DMat3::from_quat(rotation.conjugate()) * *linear - DMat3::IDENTITY,
        }
    }

    /// The same map with the logarithm of its rotation that is nearest to `turn_rad`.
    #[must_use]
    pub fn near(self, turn_rad: DVec3) -> Self {
        let angle = self.turn_rad.length();
        let axis = if angle > 1e-9 {
            self.turn_rad / angle
        } else {
            turn_rad.normalize_or_zero()
        };
        let turns = ((turn_rad.dot(axis) - angle) / TAU).round();
        Self {
            turn_rad: self.turn_rad + axis * (TAU * turns),
            ..self
        }
    }
}

/// The parts of the handles' maps under these motions. Turns are those of the handles' ways, and where these are not known
/// continue from those of the `last` step.
pub(crate) fn polars_of(last: &[Polar], handles: &[Handle], motions: &[Motion]) -> Vec<Polar> {
    let linears = handles.iter().zip(motions);
    following(
        last,
        linears.map(|(handle, motion)| (handle.linear(motion), motion.turn_rad)),
    )
}

/// The parts of the handles' maps that follow their ways, or else those of the `last` step: the logarithms nearest to them. If two are
/// equally near (half a turn), the first handle decides for all, so that handles that move alike turn alike.
fn following(last: &[Polar], linears: impl Iterator<Item = (DMat3, Option<DVec3>)>) -> Vec<Polar> {
    let mut lead = DVec3::ZERO;
    let mut followed = Vec::with_capacity(last.len());
    for (handle, (last, (linear, way_rad))) in last.iter().zip(linears).enumerate() {
        let polar = Polar::of(&linear).near(way_rad.unwrap_or(last.turn_rad + lead * BIAS));
        if handle == 0 {
            lead = polar.turn_rad;
        }
        followed.push(polar);
    }
    followed
}

/// exp(Σ w log R) (I + Σ w (S − I)): rotations are blended by the logarithms of their quaternions, stretches linearly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Blend {
    turn_rad: DVec3,
    stretch: DMat3,
    /// sin θ / θ and (1 − cos θ) / θ², θ the angle.
    sines: [f64; 2],
}

impl Blend {
    /// The blend of the handles' maps, with one weight each.
    #[inline]
    pub fn of(polars: &[Polar], weights: impl Iterator<Item = f64>) -> Self {
        let (mut turn_rad, mut stretch) = (DVec3::ZERO, DMat3::ZERO);
        for (polar, weight) in polars.iter().zip(weights) {
            turn_rad += polar.turn_rad * weight;
            stretch += polar.stretch * weight;
        }
        let square = turn_rad.length_squared();
        let sines = if square < 1e-4 {
            [
                1.0 - square / 6.0 * (1.0 - square / 20.0),
                0.5 - square / 24.0 * (1.0 - square / 30.0),
            ]
        } else {
            let angle = square.sqrt();
            let (sine, cosine) = (0.5 * angle).sin_cos();
            [2.0 * sine * cosine / angle, 2.0 * sine * sine / square]
        };
        Self {
            turn_rad,
            stretch,
            sines,
        }
    }

    /// The map's change of a vector, (T − I) v: zero to the last bit if all weights are.
    #[inline]
    pub fn change(&self, v: DVec3) -> DVec3 {
        let stretched = self.stretch * v;
        let across = self.turn_rad.cross(v + stretched);
        stretched + across * self.sines[0] + self.turn_rad.cross(across) * self.sines[1]
    }
}

#[cfg(test)]
mod tests {
    use super::{Blend, Polar, following};
    use glam::{DMat3, DQuat, DVec3};
    use std::f64::consts::PI;

    const AXIS: DVec3 = DVec3::new(0.6, 0.0, 0.8);

    fn turned(angle: f64) -> DMat3 {
        DMat3::from_quat(DQuat::from_axis_angle(AXIS, angle))
    }

    #[test]
    fn equal_maps_blend_to_themselves_and_no_weight_changes_nothing() {
        let v = DVec3::new(0.3, -2.0, 1.0);
        for linear in [
            turned(0.0),
            turned(1e-5),
            turned(3.0),
            turned(PI),
            turned(2.0) * DMat3::from_diagonal(DVec3::new(2.0, 0.5, 1.0)),
            turned(1.0) * -2.0,
            DMat3::ZERO,
        ] {
            let polars = following(&[Polar::default(); 2], [(linear, None); 2].into_iter());
            let change = Blend::of(&polars, [0.3, 0.7].into_iter()).change(v);
            assert!((change - (linear * v - v)).length() < 1e-12, "{linear}");
            assert_eq!(Blend::of(&polars, [0.0, 0.0].into_iter()).change(v), DVec3::ZERO);
        }
    }

    #[test]
    fn a_turn_goes_on_beyond_half_a_turn_and_back() {
        let mut last = [Polar::default()];
        for degree in (0_i32..=800).chain((-500..800).rev()).step_by(7) {
            let angle = f64::from(degree).to_radians();
            last[0] = following(&last, std::iter::once((turned(angle), None)))[0];
            assert!((last[0].turn_rad - AXIS * angle).length() < 1e-9, "{degree}");
        }
    }

    #[test]
    fn handles_that_make_half_a_turn_together_turn_the_same_way() {
        let rest = [Polar::default(); 3];
        let turns = [PI, PI + 1e-9, PI - 1e-9].map(|angle| (turned(angle), None));
        let polars = following(&rest, turns.into_iter());
        assert!(polars.iter().all(|p| p.turn_rad.distance(polars[0].turn_rad) < 1e-6));
    }
}
