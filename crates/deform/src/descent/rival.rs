//! The second descent at the end of a drag, from the rest shape.
//!
//! A drag goes on from its last shape, so it can end in another minimum than a solve from rest: a part that was pushed
//! through another one stays caught. When the first descent has ended at targets far from rest, a second one begins from
//! rest. The first end stays the visible shape until the second one is lower.

use glam::DQuat;

use crate::handles::Motion;
use crate::handles::blend::HandleFrame;
use crate::numerical::rotation::fit;

/// A descent that can begin a second time, from rest.
pub(crate) trait Twice {
    /// A shape at which it ended.
    type End;

    /// The handles.
    fn handles(&self) -> &[HandleFrame];

    /// The size of the bending part, in the unit of the handles' motions.
    fn size(&self) -> f64;

    /// True if the last motions were not at rest.
    fn goes_on(&self) -> bool;

    /// The second descent.
    fn rival(&mut self) -> &mut Rival<Self::End>;

    /// True if it has converged or stalled.
    fn has_ended(&self) -> bool;

    /// The energy of the present shape.
    fn energy(&self) -> f64;

    /// The energy of an end.
    fn energy_at(end: &Self::End) -> f64;

    /// The present shape as an end.
    fn end(&self) -> Self::End;

    /// Begins the descent to the present targets again, from rest.
    fn begin_again(&mut self);

    /// Returns true if every part of the present shape is within [`NEAR`] of the end.
    fn is_near(&self, end: &Self::End) -> bool;

    /// Makes the end the present shape.
    fn put_back(&mut self, end: Self::End);
}

/// Before a step towards other targets: a second descent becomes due where it may find another minimum, and one that
/// has not ended gives way to the first end.
pub(crate) fn aim(descent: &mut impl Twice, motions: &[Motion]) {
    let goes_on = descent.goes_on() && !motions.iter().any(Motion::is_wound);
    let is_far = is_far(descent.handles(), motions, descent.size());
    if let Some(first) = descent.rival().aim(goes_on, is_far) {
        descent.put_back(first);
    }
}

/// After a step: begins the second descent when the first one has ended, and keeps the lower end when the second one
/// has.
pub(crate) fn compare(descent: &mut impl Twice) {
    let is_finite = descent.energy().is_finite();
    match std::mem::take(&mut descent.rival().stage) {
        Stage::Against(first) if !is_finite => {
            descent.rival().end();
            descent.put_back(first);
        }
        _ if !is_finite => descent.rival().end(),
        Stage::Due if descent.has_ended() => {
            descent.rival().stage = Stage::Against(descent.end());
            descent.begin_again();
        }
        Stage::Against(first) => keep_lower(descent, first),
        other => descent.rival().stage = other,
    }
}

/// Ends the second descent if it has ended or comes near the `first` end, and keeps the lower one.
fn keep_lower<D: Twice>(descent: &mut D, first: D::End) {
    if !descent.has_ended() && !descent.is_near(&first) {
        descent.rival().stage = Stage::Against(first);
        return;
    }
    descent.rival().end();
    if descent.energy() >= (1.0 - LOWER) * D::energy_at(&first) {
        descent.put_back(first);
    }
}

/// The second descent for the present targets. `S` is the end of the first one.
#[derive(Debug)]
pub(crate) struct Rival<S> {
    pub stage: Stage<S>,
    /// True if targets were far from rest since the last comparison.
    was_far: bool,
}

/// The progress of the second descent.
#[derive(Debug, Default)]
pub(crate) enum Stage<S> {
    /// There is none, or it has ended.
    #[default]
    Over,
    /// It begins when the first descent ends.
    Due,
    /// It descends.
    Against(S),
}

impl<S> Default for Rival<S> {
    fn default() -> Self {
        Self {
            stage: Stage::Over,
            was_far: false,
        }
    }
}

impl<S> Rival<S> {
    /// Prepares for new targets: a second descent is due if the first one goes on from another shape than rest, and if
    /// targets were far from rest. Returns the end of the first descent if the second one has not ended.
    fn aim(&mut self, goes_on: bool, is_far: bool) -> Option<S> {
        self.was_far |= is_far;
        let is_due = goes_on && self.was_far;
        let next = if is_due { Stage::Due } else { Stage::Over };
        match std::mem::replace(&mut self.stage, next) {
            Stage::Against(first) => Some(first),
            Stage::Over | Stage::Due => None,
        }
    }

    /// The end of the first descent while a second one descends.
    pub fn first(&self) -> Option<&S> {
        match &self.stage {
            Stage::Against(first) => Some(first),
            Stage::Over | Stage::Due => None,
        }
    }

    /// Notes that the two ends were compared.
    pub fn end(&mut self) {
        *self = Self::default();
    }
}

/// The second end must be lower by this share of the first one's energy.
const LOWER: f64 = 1e-3;

/// The second descent ends early if no vertex is farther from the first end than this share of the size: it is on its
/// way to the same minimum.
pub(crate) const NEAR: f64 = 0.01;

/// Targets are far from rest if a handle has turned by more than this, in radians ..
const TURN_RAD: f64 = std::f64::consts::FRAC_PI_2;

/// .. or has moved by more than this share of the size.
const SHIFT: f64 = 0.5;

/// Returns true if these motions of the handles are so far from rest that a drag may end in another minimum. `size` is
/// about the model's.
fn is_far(handles: &[HandleFrame], motions: &[Motion], size: f64) -> bool {
    handles.iter().zip(motions).any(|(handle, motion)| {
        let turn = fit(&handle.linear(motion), DQuat::IDENTITY);
        2.0 * turn.w.abs().min(1.0).acos() > TURN_RAD || motion.shift.length() > SHIFT * size
    })
}
