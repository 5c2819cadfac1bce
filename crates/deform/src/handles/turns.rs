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
    /// The ends between which a limb bends.
    pub ends: Vec<Ends>,
}

/// A handle and what bounds a limb on its other side: another handle, or `None` for what is fixed.
pub(crate) type Ends = (u16, Option<u16>);

/// Every two of these handles, which ascend, and each of them with what is fixed.
pub(crate) fn ends_among(handles: &[u16], is_held: bool) -> impl Iterator<Item = Ends> + '_ {
    let fixed = is_held.then_some(None);
    handles.iter().enumerate().flat_map(move |(place, handle)| {
        let others = handles[..place].iter().copied().map(Some);
        others.chain(fixed).map(move |other| (*handle, other))
    })
}

/// The warning waits for this much more than the limit, so that a turn by the limit itself gives none.
const ROOM_DEGREES: f64 = 5.0;

impl TurnLimit {
    /// Forgets the ends at other handles.
    pub fn retain(&mut self, is_counted: impl Fn(u16) -> bool) {
        self.ends
            .retain(|(handle, other)| is_counted(*handle) && other.is_none_or(&is_counted));
    }

    /// A sentence about two ends whose turns differ by more than the method's limit.
    pub fn warning(&self, handles: &[Handle], motions: &[Motion]) -> Option<Warning> {
        let Followed {
            most_degrees,
            beyond,
            necks_degrees,
        } = self.followed;
        if self.ends.is_empty() {
            return None;
        }
        // Once for each handle: there may be hundreds, and many more pairs of them.
        let of_handles = handles.iter().zip(motions);
        let turns: Vec<DQuat> = of_handles
            .map(|(handle, motion)| DQuat::from_scaled_axis(Polar::of(&handle.linear(motion)).turn_rad))
            .collect();
        let turn = |number: u16| turns[usize::from(number)];
        let mut worst = (0.0, 0);
        for (number, other) in &self.ends {
            let beyond = other.map_or(DQuat::IDENTITY, turn);
            let degrees = degrees_between(turn(*number), beyond);
            if degrees > worst.0 {
                // The person has turned the one that is farther from rest.
                let from_rest = |number: u16| degrees_between(turn(number), DQuat::IDENTITY);
                let turned = other.filter(|other| from_rest(*other) > from_rest(*number));
                worst = (degrees, usize::from(turned.unwrap_or(*number)));
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

/// The angle between two turns, from 0 to 180 degrees.
fn degrees_between(one: DQuat, other: DQuat) -> f64 {
    // The angle's cosine would lose small angles.
    let between = (one * other.conjugate()).to_scaled_axis().length();
    between.min(std::f64::consts::TAU - between).to_degrees()
}
