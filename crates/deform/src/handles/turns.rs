//! Turns beyond a method's limit.

use glam::DQuat;

use super::polar::Polar;
use super::{Handle, Motion};
use crate::{Remedy, Warning};

/// The largest turn between handles, or between a handle and a fixed vertex, that leaves a limb at least about 0.7 of
/// its radius everywhere, by `tests/large_turns.rs`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Followed {
    most_degrees: f64,
    /// The effect of larger turns.
    beyond: &'static str,
    /// The turn from which a twisted limb narrows at thin places too, if that is another one.
    necks_degrees: Option<f64>,
}

impl Followed {
    fn until(most_degrees: f64, beyond: &'static str) -> Self {
        Self {
            most_degrees,
            beyond,
            necks_degrees: None,
        }
    }

    /// Every limb narrows.
    pub fn by_limbs(most_degrees: f64) -> Self {
        Self::until(most_degrees, "narrows the limb")
    }

    /// A limb narrows only where it is thinner than elsewhere.
    pub fn by_necks(most_degrees: f64) -> Self {
        Self::until(most_degrees, NARROWS_NECKS)
    }

    /// A limb that is folded is flattened; one that is twisted keeps its radius.
    pub fn by_folds(most_degrees: f64) -> Self {
        Self::until(
            most_degrees,
            "flattens a limb that is folded, though not one that is twisted",
        )
    }

    /// A limb that is folded is flattened; one that is twisted narrows where it is thinner than elsewhere, from a larger
    /// turn on.
    pub fn by_folds_and_necks(most_degrees: f64, necks_degrees: f64) -> Self {
        Self {
            necks_degrees: Some(necks_degrees),
            ..Self::by_folds(most_degrees)
        }
    }

    /// All of the turn is in one place.
    pub fn by_seams(most_degrees: f64) -> Self {
        Self::until(most_degrees, "twists the limb in one place")
    }
}

const NARROWS_NECKS: &str = "narrows the limb at thin places";

/// The limit of a method, and its name.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct TurnLimit {
    pub method: &'static str,
    pub followed: Followed,
    /// True if something is fixed.
    pub is_held: bool,
    /// For each handle, false if it holds parts of the surface as a whole, so that no limb ends at it.
    pub bends: Vec<bool>,
}

/// The warning waits for this much more than the limit, so that a turn by the limit itself gives none.
const ROOM_DEGREES: f64 = 5.0;

impl TurnLimit {
    /// A sentence about two turns that differ by more than the method's limit.
    pub fn warning(&self, handles: &[Handle], motions: &[Motion]) -> Option<Warning> {
        self.warning_of(handles, motions, &vec![true; handles.len()])
    }

    /// The same about the handles that are `counted`.
    pub fn warning_of(&self, handles: &[Handle], motions: &[Motion], counted: &[bool]) -> Option<Warning> {
        let Followed {
            most_degrees,
            beyond,
            necks_degrees,
        } = self.followed;
        let turn = |(handle, motion): (&Handle, &Motion)| Polar::of(&handle.linear(motion)).turn_rad;
        let own = handles.iter().zip(motions).enumerate();
        let turns: Vec<(usize, DQuat)> = own
            .filter(|(number, _)| counted[*number] && self.bends[*number])
            .map(|(number, own)| (number, DQuat::from_scaled_axis(turn(own))))
            .collect();
        let fixed = self.is_held.then_some((usize::MAX, DQuat::IDENTITY));
        let mut worst = (0.0, 0);
        for (place, (number, turn)) in turns.iter().enumerate() {
            for (_, other) in turns[..place].iter().chain(&fixed) {
                // The angle's cosine would lose small angles.
                let between = (*turn * other.conjugate()).to_scaled_axis().length();
                let degrees = between.min(std::f64::consts::TAU - between).to_degrees();
                if degrees > worst.0 {
                    worst = (degrees, *number);
                }
            }
        }
        let (degrees, number) = worst;
        let others = Remedy::FollowingTurns(degrees.ceil() as u16);
        let beyond = match necks_degrees {
            Some(necks_degrees) if degrees > necks_degrees => {
                format!("flattens a limb that is folded, and from {necks_degrees:.0}° on it {NARROWS_NECKS} in a twist")
            }
            _ => beyond.to_owned(),
        };
        (degrees > most_degrees + ROOM_DEGREES).then(|| {
            Warning::of_handle(number, |handle| {
                format!(
                    "{handle} turns by {degrees:.0}° against the other end of its region. From about \
                     {most_degrees:.0}° on, `{}` {beyond}: take {others}, or turn it in parts",
                    self.method
                )
            })
        })
    }
}
