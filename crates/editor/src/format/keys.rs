//! The keys of an edit: handles' transforms at times, or at frames of a sequence.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use pliant_deform::LARGEST_WEIGHT;

use super::edit_error::EditError;
use super::strength::strength_kind;
use super::transform::Numbers;
use crate::HandleTransform;
use crate::document::{HandleCurve, SHARPEN_RANGE};
use crate::ease::Ease;
use crate::key_space::KeySpace;

/// The transforms of some handles at a time, or at a frame of a sequence.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeyEntry {
    /// In seconds, at least 0: a key of an animation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// The frame, counted from 0: a key of a sequence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<u32>,
    /// The first and the last frame over which a sequence's key spreads.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub span: Option<[u32; 2]>,
    /// The axes in which a sequence's key stays the same.
    #[serde(default, skip_serializing_if = "is_local")]
    pub space: KeySpace,
    /// The way to the next key; in a sequence also the way from rest and back to it.
    #[serde(default, skip_serializing_if = "is_smooth")]
    pub ease: Ease,
    /// The transforms, by the handles' names.
    #[serde(default)]
    pub handles: BTreeMap<String, HandleTransform>,
    /// Where handles' curves go, by the handles' names: a key of an animation.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub curves: BTreeMap<String, CurveKey>,
    /// The weights of the method's examples, in their order; null is one that the solver finds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<Option<f64>>>,
    /// The share of the edit that is made, from 0 to 1. If a key has one, it is instead of the edit's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strength: Option<f64>,
}

/// Where the control points of a handle's curve go. A list that is left out has the values at rest.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurveKey {
    /// The positions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) moved: Option<Vec<Numbers<3>>>,
    /// The twists, in degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) twist: Option<Vec<f64>>,
    /// The scales.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) scale: Option<Vec<f64>>,
    /// The sharpness of its crease.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) sharpen: Option<f64>,
}

impl CurveKey {
    /// The key of a curve.
    pub(super) fn of(curve: &HandleCurve) -> Self {
        let moved = curve.moved().iter().map(|point| Numbers(point.to_array()));
        Self {
            moved: Some(moved.collect()),
            twist: Some(curve.twist_deg().to_vec()),
            scale: Some(curve.scale().to_vec()),
            sharpen: curve.crease().map(|crease| crease.sharpen()),
        }
    }

    /// The curve of a handle at this key.
    ///
    /// # Errors
    /// The list that makes no curve, and its fault, or a sharpness out of its range.
    pub(super) fn on(&self, curve: &HandleCurve) -> Result<HandleCurve, String> {
        let rest = curve.rest();
        let points = rest.points().to_vec();
        let count = points.len();
        let moved = self.moved.as_ref();
        let sharpen = self.sharpen.unwrap_or_default();
        if !SHARPEN_RANGE.contains(&sharpen) {
            let (flat, sharp) = (SHARPEN_RANGE.start(), SHARPEN_RANGE.end());
            return Err(format!(
                "has `sharpen` {sharpen}: give a number from {flat} (flat) to {sharp}"
            ));
        }
        HandleCurve::new(
            points.clone(),
            rest.is_closed(),
            moved.map_or(points, |moved| moved.iter().map(|own| own.0.into()).collect()),
            self.twist.clone().unwrap_or_else(|| vec![0.0; count]),
            self.scale.clone().unwrap_or_else(|| vec![1.0; count]),
        )
        .map(|keyed| keyed.with_settings_of(curve).sharpened(sharpen))
        .map_err(|(list, refused)| format!("can't be followed: its `{list}` {refused}"))
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes by reference")]
fn is_smooth(ease: &Ease) -> bool {
    *ease == Ease::Smooth
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes by reference")]
fn is_local(space: &KeySpace) -> bool {
    *space == KeySpace::Local
}

/// Refuses keys of animations and of sequences in one list, and members that don't fit together.
pub(super) fn check_keys(keys: &[KeyEntry]) -> Result<(), EditError> {
    for (place, key) in keys.iter().enumerate() {
        let refuse = |sentence: &str| {
            Err(EditError::Other {
                place: format!("keys[{place}]"),
                sentence: sentence.to_owned(),
            })
        };
        match (key.time, key.frame) {
            (Some(_), Some(_)) => {
                return refuse("has both `time` and `frame`: keep the time in an animation, the frame in a sequence");
            }
            (None, None) => {
                return Err(EditError::Missing {
                    member: "time",
                    place: format!("keys[{place}]"),
                });
            }
            (Some(_), None) if key.span.is_some() || key.space != KeySpace::Local => {
                return refuse(
                    "has a `time`, so it takes no `span` and no `space`: those are for frames of a sequence",
                );
            }
            (Some(time), None) => check_time(keys, place, time)?,
            (None, Some(_)) if !key.curves.is_empty() || key.weights.is_some() || key.strength.is_some() => {
                return refuse(
                    "has a `frame`, so it takes no `curves`, no `weights` and no `strength`: those are for keys with a \
                     `time`",
                );
            }
            (None, Some(frame)) => check_span(place, frame, key.span)?,
        }
        if let Some(strength) = key.strength {
            let place = format!("keys[{place}].strength");
            strength_kind().check(strength).map_err(|error| error.under(&place))?;
        }
        let weights = key.weights.iter().flatten().flatten();
        if let Some(weight) = weights
            .copied()
            .find(|weight| !(-LARGEST_WEIGHT..=LARGEST_WEIGHT).contains(weight))
        {
            return Err(EditError::OutOfRange {
                place: format!("keys[{place}].weights"),
                found: weight.to_string(),
                allowed: format!("numbers from -{LARGEST_WEIGHT} to {LARGEST_WEIGHT}, or null"),
            });
        }
        if key.time.is_some() != keys[0].time.is_some() {
            return refuse("differs from the others: give all keys a `time`, or all of them a `frame`");
        }
    }
    Ok(())
}

/// Refuses a time below 0, and one that an earlier key has.
fn check_time(keys: &[KeyEntry], place: usize, time: f64) -> Result<(), EditError> {
    let allowed = if time < 0.0 {
        "a time in seconds of at least 0"
    } else if keys[..place].iter().any(|other| other.time == Some(time)) {
        "a time that no other key has"
    } else {
        return Ok(());
    };
    Err(EditError::OutOfRange {
        place: format!("keys[{place}].time"),
        found: time.to_string(),
        allowed: allowed.to_owned(),
    })
}

/// Refuses a span that does not hold its key's frame.
fn check_span(place: usize, frame: u32, span: Option<[u32; 2]>) -> Result<(), EditError> {
    match span {
        None => Err(EditError::Missing {
            member: "span",
            place: format!("keys[{place}]"),
        }),
        Some([first, last]) if first > frame || frame > last => Err(EditError::OutOfRange {
            place: format!("keys[{place}].span"),
            found: format!("[{first}, {last}]"),
            allowed: format!("a first frame up to the key's own, {frame}, and a last frame from there on"),
        }),
        Some(_) => Ok(()),
    }
}
