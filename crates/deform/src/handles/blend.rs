//! A start that is already bent: each point moved by exp(Σ w_h log T_h), with the handles' harmonic weights w.
//!
//! Rigid parts are blended as screw motions about one common origin, so that handles that move alike move everything
//! rigidly; stretches are blended linearly before.

use glam::{DMat3, DQuat, DVec3};

use crate::handles::polar::Polar;
use crate::handles::{Handle, Motion};
use crate::numerical::rotation::fit;

/// If a map's determinant is below this, in units of its largest entry's cube, only its rotation is used.
const SINGULAR: f64 = 1e-3;

/// A handle's motion as its rigid part's logarithm and its stretch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Screw {
    /// Axis times angle, in radians.
    turn_rad: DVec3,
    /// The velocity at the common origin.
    slide: DVec3,
    /// The fixed point of the stretch.
    centre: DVec3,
    /// The stretch less the identity.
    stretch: DMat3,
}

impl Screw {
    /// The motion whose linear part is `linear` and that moves the point `centre` by `shift`; all points here are
    /// relative to the common origin.
    pub fn of(linear: DMat3, shift: DVec3, centre: DVec3) -> Self {
        let Polar { turn_rad, stretch } = Polar::of(&linear);
        // The velocity at the origin of the screw whose exponential shifts the centre by `shift`.
        let at_centre = if turn_rad == DVec3::ZERO {
            shift
        } else {
            slides(turn_rad).inverse() * shift
        };
        Self {
            turn_rad,
            slide: at_centre + centre.cross(turn_rad),
            centre,
            stretch,
        }
    }

    /// The rotation, without the stretch.
    pub fn turn(&self) -> DQuat {
        carried(DVec3::ZERO, std::slice::from_ref(self), &[1.0])
            .turn
            .normalize()
    }
}

/// The image of a point under the screws.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carried {
    /// The displacement of the point.
    pub displacement: DVec3,
    /// The rotation of its surroundings.
    pub turn: DQuat,
}

/// The point under exp(Σ w log T).
pub(crate) fn carried(point: DVec3, screws: &[Screw], weights: &[f64]) -> Carried {
    let (mut turn_rad, mut slide, mut stretch) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    for (screw, &weight) in screws.iter().zip(weights) {
        turn_rad += screw.turn_rad * weight;
        slide += screw.slide * weight;
        stretch += screw.stretch * (point - screw.centre) * weight;
    }
    let arm = point + stretch;
    let angle = turn_rad.length();
    let square = angle * angle;
    // sin θ / θ, (1 − cos θ) / θ² and (θ − sin θ) / θ³, and the quaternion's sin(θ/2) / θ and cos(θ/2).
    let (sine, first, second, half_sine, half_cosine) = if angle < 1e-2 {
        (
            1.0 - square / 6.0 * (1.0 - square / 20.0),
            0.5 - square / 24.0 * (1.0 - square / 30.0),
            (1.0 - square / 20.0 * (1.0 - square / 42.0)) / 6.0,
            0.5 - square / 48.0 * (1.0 - square / 80.0),
            1.0 - square / 8.0 * (1.0 - square / 48.0),
        )
    } else {
        let (s, c) = (0.5 * angle).sin_cos();
        let sine = 2.0 * s * c;
        (
            sine / angle,
            2.0 * s * s / square,
            (angle - sine) / (square * angle),
            s / angle,
            c,
        )
    };
    let across = turn_rad.cross(arm);
    let turned = across * sine + turn_rad.cross(across) * first;
    let across = turn_rad.cross(slide);
    let slid = slide + across * first + turn_rad.cross(across) * second;
    let axis = turn_rad * half_sine;
    Carried {
        displacement: stretch + turned + slid,
        turn: DQuat::from_xyzw(axis.x, axis.y, axis.z, half_cosine),
    }
}

/// V with exp(turn, slide) = (exp(turn), V slide), the left Jacobian of the rotations.
fn slides(turn: DVec3) -> DMat3 {
    let angle = turn.length();
    let cross = DMat3::from_cols(turn.cross(DVec3::X), turn.cross(DVec3::Y), turn.cross(DVec3::Z));
    let (first, second) = if angle < 1e-4 {
        (0.5 - angle * angle / 24.0, (1.0 - angle * angle / 20.0) / 6.0)
    } else {
        let square = angle * angle;
        ((1.0 - angle.cos()) / square, (angle - angle.sin()) / (square * angle))
    };
    DMat3::IDENTITY + cross * first + cross * cross * second
}

/// Each handle's motion from rest, and from its last place.
pub(crate) struct Screws {
    pub from_rest: Vec<Screw>,
    pub onwards: Vec<Screw>,
}

impl Screws {
    /// The starts for handles that moved by `old` and shall now move by `new`.
    pub fn of(handles: &[HandleFrame], old: &[Motion], new: &[Motion]) -> Self {
        let frames = || handles.iter().zip(old.iter().zip(new));
        Self {
            from_rest: frames()
                .map(|(handle, (_, new))| Screw::of(handle.linear(new), new.shift, handle.centre))
                .collect(),
            onwards: frames().map(|(handle, (old, new))| handle.onwards(old, new)).collect(),
        }
    }
}

/// The shape or pose from which a start is made.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Origin {
    Rest,
    Current,
}

/// A handle in coordinates relative to the solver's origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HandleFrame {
    pub centre: DVec3,
    pub radius: f64,
}

impl HandleFrame {
    /// The centre of each handle, relative to `world_origin`.
    pub fn of_all(handles: &[Handle], world_origin: DVec3) -> Vec<Self> {
        let frame = |handle: &Handle| Self {
            centre: handle.world_centre - world_origin,
            radius: handle.radius,
        };
        handles.iter().map(frame).collect()
    }

    /// The linear part of the map.
    pub fn linear(&self, motion: &Motion) -> DMat3 {
        DMat3::IDENTITY + motion.linear * self.radius.recip()
    }

    /// The map from a point's position under `old` to its position under `new`.
    pub fn onwards(&self, old: &Motion, new: &Motion) -> Screw {
        let (mut from, mut to) = (self.linear(old), self.linear(new));
        let largest = from.to_cols_array().into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let is_sound = from.determinant().abs() > SINGULAR * largest.powi(3);
        if !is_sound {
            (from, to) = (
                DMat3::from_quat(fit(&from, DQuat::IDENTITY)),
                DMat3::from_quat(fit(&to, DQuat::IDENTITY)),
            );
        }
        Screw::of(to * from.inverse(), new.shift - old.shift, self.centre + old.shift)
    }
}

#[cfg(test)]
mod tests {
    use super::{Screw, carried};
    use glam::{DAffine3, DMat3, DQuat, DVec3};

    #[test]
    fn whole_weights_give_the_whole_motion_and_none_gives_none() {
        let centre = DVec3::new(1.0, 2.0, 3.0);
        for (angle, shift, scale) in [
            (0.0, DVec3::new(0.1, 0.2, 0.3), 1.0),
            (1e-6, DVec3::ZERO, 1.0),
            (2.0, DVec3::new(5.0, -2.0, 0.0), 2.0),
            (std::f64::consts::PI, DVec3::X, 0.0),
            (3.0, DVec3::Y, -1.0),
        ] {
            let linear = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle)) * scale;
            let screw = Screw::of(linear, shift, centre);
            let map = DAffine3::from_mat3_translation(linear, centre + shift - linear * centre);
            let point = DVec3::new(0.3, -7.0, 1.0);
            let expected = map.transform_point3(point) - point;
            // Two handles that move alike share the weight.
            let found = carried(point, &[screw, screw], &[0.3, 0.7]).displacement;
            assert!((found - expected).length() < 1e-9, "{angle}: {found} {expected}");
            assert_eq!(carried(point, &[screw], &[0.0]).displacement, DVec3::ZERO);
        }
    }
}
