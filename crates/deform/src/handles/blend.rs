//! A start that is already bent: each point moved by exp(Σ w_h log T_h), with the handles' harmonic weights w
//! (`screw.rs`).

use glam::{DMat3, DQuat, DVec3};

use super::screw::Screw;
use crate::handles::{Handle, Motion};
use crate::numerical::rotation::fit;

/// If a map's determinant is below this, in units of its largest entry's cube, only its rotation is used.
const SINGULAR: f64 = 1e-3;

/// Each handle's motion from rest, and from its last place.
pub(crate) struct Screws {
    pub from_rest: Vec<Screw>,
    pub onwards: Vec<Screw>,
    /// False if the last shape lacks full turns: a handle's map may be the same as before.
    pub may_stay: bool,
}

impl Screws {
    /// The starts for handles that moved by `old` and shall now move by `new`.
    pub fn of(handles: &[HandleFrame], old: &[Motion], new: &[Motion]) -> Self {
        let frames = || handles.iter().zip(old.iter().zip(new));
        let onwards: Vec<Screw> = frames().map(|(handle, (old, new))| handle.onwards(old, new)).collect();
        Self {
            from_rest: frames()
                .map(|(handle, (_, new))| Screw::of(handle.linear(new), new.turn_rad, new.shift, handle.centre))
                .collect(),
            may_stay: !onwards.iter().any(Screw::winds),
            onwards,
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
        let turn = match (old.turn_rad, new.turn_rad) {
            (None, None) => None,
            (old, new) => Some(new.unwrap_or_default() - old.unwrap_or_default()),
        };
        Screw::of(
            to * from.inverse(),
            turn,
            new.shift - old.shift,
            self.centre + old.shift,
        )
    }
}
