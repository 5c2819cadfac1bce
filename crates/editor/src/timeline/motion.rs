//! An edit over time: all handles, their curves, the weights of examples, and the share of the edit that is made.

use super::numbers::{NumberTrack, Values};
use super::track::Track;
use crate::document::{HandleCurve, SplitTransform};

/// The motions of an edit with keys.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Timeline {
    /// A track for each handle; those without keys have none.
    pub(crate) tracks: Vec<Track>,
    /// The curves that handles follow, by the handles' numbers: where they are at rest, and the keys of the rest.
    pub(crate) curves: Vec<(usize, HandleCurve, NumberTrack)>,
    /// The weights of the examples; NaN is one that the solver finds.
    pub(crate) weights: NumberTrack,
    /// The share of the edit, if it has keys: transforms and curves are then the whole ones.
    pub(crate) strength: NumberTrack,
    /// The time of the last key, in seconds.
    pub(crate) duration: f64,
}

impl Timeline {
    /// The time of the last key, in seconds.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Returns true if the handle at this place of the list has a key.
    pub(crate) fn is_keyed(&self, place: usize) -> bool {
        self.tracks.get(place).is_some_and(|track| track.at(0.0).is_some())
    }

    /// The handles' transforms at a time in seconds; `None` for a handle without keys.
    pub(crate) fn transforms_at(&self, time: f64) -> impl Iterator<Item = Option<SplitTransform>> {
        self.tracks.iter().map(move |track| track.at(time))
    }

    /// The curves at a time, by the handles' numbers.
    pub(crate) fn curves_at(&self, time: f64) -> Vec<(usize, HandleCurve)> {
        let at = |(handle, rest, track): &(usize, HandleCurve, NumberTrack)| {
            let (values, before) = track.at(time)?;
            // Points that meet on their way make no curve: the last key's stays until they part.
            let curve = with_values(rest, &values).or_else(|| with_values(rest, before))?;
            Some((*handle, curve))
        };
        self.curves.iter().filter_map(at).collect()
    }

    /// The weights of the examples at a time, if they have keys; `None` for one that the solver finds.
    pub(crate) fn weights_at(&self, time: f64) -> Option<Vec<Option<f64>>> {
        let (values, _) = self.weights.at(time)?;
        let weight = |number: &f64| Some(*number).filter(|number| !number.is_nan());
        Some(values.numbers.iter().map(weight).collect())
    }

    /// The share of the edit at a time; 1 if it has no keys.
    pub(crate) fn strength_at(&self, time: f64) -> f64 {
        self.strength.at(time).map_or(1.0, |(values, _)| values.numbers[0])
    }

    /// Returns true if no key of a curve or of a weight moves anything.
    pub fn keeps_curves_and_weights(&self) -> bool {
        let mut weights = self.weights.values().flat_map(|values| &values.numbers);
        let rests = |(_, rest, track): &(usize, HandleCurve, NumberTrack)| {
            track
                .values()
                .all(|values| with_values(rest, values).is_some_and(|curve| curve.is_rest()))
        };
        weights.all(|weight| *weight == 0.0) && self.curves.iter().all(rests)
    }
}

/// The values of a curve at a key.
pub(crate) fn values_of(curve: &HandleCurve) -> Values {
    let sharpen = curve.crease().map(|crease| crease.sharpen());
    let numbers = curve.twist_deg().iter().chain(curve.scale()).chain(&sharpen);
    Values {
        vectors: curve.moved().to_vec(),
        numbers: numbers.copied().collect(),
    }
}

/// The curve with these values; `None` if they make none.
pub(super) fn with_values(rest: &HandleCurve, values: &Values) -> Option<HandleCurve> {
    let (twist, others) = values.numbers.split_at(values.vectors.len());
    let (scale, sharpen) = others.split_at(values.vectors.len());
    let curve = rest.with(values.vectors.clone(), twist.to_vec(), scale.to_vec())?;
    Some(curve.sharpened(sharpen.first().copied().unwrap_or_default()))
}
