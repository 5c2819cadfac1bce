//! Turns that are more than a method follows.

use glam::DQuat;

use super::polar::Polar;
use super::{Handle, Motion};
use crate::Warning;

/// What a method follows, and what it is called.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct TurnLimit {
    pub method: &'static str,
    /// The largest angle between the turns of two handles, or of a handle and what is fixed.
    pub most_degrees: f64,
    /// Whether something is fixed.
    pub is_held: bool,
}

/// The warning waits for this much more than the limit, so that a turn by the limit itself is none.
const ROOM_DEGREES: f64 = 5.0;

impl TurnLimit {
    /// A sentence where two turns are further apart than the method follows.
    pub fn warning(&self, handles: &[Handle], motions: &[Motion]) -> Option<Warning> {
        let turn = |(handle, motion): (&Handle, &Motion)| Polar::of(&handle.linear(motion)).turn_rad;
        let turns: Vec<DQuat> = handles
            .iter()
            .zip(motions)
            .map(|own| DQuat::from_scaled_axis(turn(own)))
            .collect();
        let fixed = self.is_held.then_some(DQuat::IDENTITY);
        let mut worst = (0.0, 0);
        for (number, turn) in turns.iter().enumerate() {
            for other in turns[..number].iter().chain(&fixed) {
                // Not by the angle's cosine, which loses the small ones.
                let between = (*turn * other.conjugate()).to_scaled_axis().length();
                let degrees = between.min(std::f64::consts::TAU - between).to_degrees();
                if degrees > worst.0 {
                    worst = (degrees, number);
                }
            }
        }
        let (degrees, number) = worst;
        (degrees > self.most_degrees + ROOM_DEGREES).then(|| {
            Warning::of_handle(number, |handle| {
                format!(
                    "{handle} turns by {degrees:.0}° against what it bends, which {} narrows from about {:.0}° on: take \
                     poisson, frames or arap, or turn it in parts",
                    self.method, self.most_degrees
                )
            })
        })
    }
}
