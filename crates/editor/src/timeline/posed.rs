//! The handles and weights of a document over time.

use std::sync::Arc;

use pliant_deform::Attachment;

use super::motion::{values_of, with_values};
use super::numbers::{NumberTrack, Values};
use super::track::{Key, Track};
use crate::document::{
    Animation, Document, Handle, HandleCurve, HandleId, HandleLine, HandleTransform, KeyFrame, SplitTransform,
};
use crate::ease::Ease;

/// The motion of a handle through these keys, by time; none without a key of it.
fn track(keys: &[KeyFrame], handle: HandleId) -> Option<Track> {
    let own = keys.iter().filter_map(|key| {
        let placed = key.handles.get(&handle)?;
        Some(Key {
            time: key.time,
            ease: key.ease,
            transform: SplitTransform::of(&placed.stance.transform, placed.pivot),
        })
    });
    let own: Vec<Key> = own.collect();
    (!own.is_empty()).then(|| Track::new(own))
}

/// The track of the values that some keys have.
fn numbers(keys: &[KeyFrame], of: impl Fn(&KeyFrame) -> Option<Values>) -> NumberTrack {
    let keyed = |key: &KeyFrame| -> Option<(f64, Ease, Values)> { Some((key.time, key.ease, of(key)?)) };
    NumberTrack::new(keys.iter().filter_map(keyed).collect())
}

/// The curve of a handle at a time, if it has keys on the curve at rest that it has now.
fn curve_at(keys: &[KeyFrame], handle: &Handle, time: f64) -> Option<HandleCurve> {
    let present = handle.line.as_ref()?.curve()?;
    let of_key = |key: &KeyFrame| {
        let own = key.curves.get(&handle.id)?;
        own.is_keyed_as(present).then(|| values_of(own))
    };
    let track = numbers(keys, of_key);
    let (values, before) = track.at(time)?;
    with_values(present, &values).or_else(|| with_values(present, before))
}

/// The weights of `count` examples at a time, if they have keys.
fn weights_at(keys: &[KeyFrame], count: usize, time: f64) -> Option<Vec<Option<f64>>> {
    let of_key = |key: &KeyFrame| {
        let weights = key.weights.as_ref().filter(|own| own.len() == count)?;
        Some(Values {
            numbers: weights.iter().map(|weight| weight.unwrap_or(f64::NAN)).collect(),
            vectors: Vec::new(),
        })
    };
    let track = numbers(keys, of_key);
    let (values, _) = track.at(time)?;
    let weight = |number: &f64| Some(*number).filter(|number| !number.is_nan());
    Some(values.numbers.iter().map(weight).collect())
}

/// The share of the edit at a time, if it has keys.
fn strength_at(keys: &[KeyFrame], time: f64) -> Option<f64> {
    let of_key = |key: &KeyFrame| {
        Some(Values {
            numbers: vec![key.strength?],
            vectors: Vec::new(),
        })
    };
    let track = numbers(keys, of_key);
    let (values, _) = track.at(time)?;
    values.numbers.first().copied()
}

/// The parts of a document that its keys move, where they have them at a moment; only those that are elsewhere now.
#[derive(Default)]
pub(crate) struct Posed {
    /// The share of the edit, if it has keys: everything else is whole then.
    strength: Option<f64>,
    /// True if another share than that of the keys is shown now.
    is_other_share: bool,
    transforms: Vec<(HandleId, HandleTransform)>,
    curves: Vec<(HandleId, HandleCurve)>,
    weights: Option<(&'static str, Attachment)>,
}

impl Posed {
    /// At a time in seconds.
    pub(crate) fn at(animation: &Animation, document: &Document, time: f64) -> Self {
        let keys = animation.keys();
        let strength = strength_at(keys, time);
        let has_handles = keys.iter().any(|key| key.handles().count() > 0);
        let share = strength.or_else(|| has_handles.then_some(1.0));
        let mut posed = Self {
            strength,
            is_other_share: share.is_some_and(|share| share != document.strength()),
            ..Self::default()
        };
        let in_full = strength.map(|_| document.in_full());
        let document = in_full.as_ref().unwrap_or(document);
        for handle in document.handles() {
            if let Some(transform) = track(keys, handle.id).and_then(|track| track.at(time)) {
                let transform = transform.about(handle.pivot);
                if handle.affine() != transform.affine(handle.pivot) {
                    posed.transforms.push((handle.id, transform));
                }
            }
            if let Some(curve) = curve_at(keys, handle, time)
                && handle.line.as_ref().and_then(HandleLine::curve) != Some(&curve)
            {
                posed.curves.push((handle.id, curve));
            }
        }
        if let (Some(name), Some(examples)) = (document.examples_name(), document.examples())
            && let Some(weights) = weights_at(keys, examples.weights.len(), time)
            && weights != examples.weights
        {
            let mut examples = examples.clone();
            examples.weights = weights;
            posed.weights = Some((name, Attachment::Shapes(examples)));
        }
        posed
    }

    /// Returns true if everything is there.
    pub(crate) fn is_empty(&self) -> bool {
        !self.is_other_share && self.transforms.is_empty() && self.curves.is_empty() && self.weights.is_none()
    }

    /// Puts everything there. Without keys of the strength the keys have shown values: if the document shows a share of an
    /// edit, that share becomes the whole.
    pub(crate) fn put(self, document: &mut Document) {
        if self.is_empty() {
            return;
        }
        if self.strength.is_some() {
            document.take_part(1.0);
        }
        let share = document.strength();
        document.change_handles(|handles| {
            for handle in handles.iter_mut() {
                if let Some((_, transform)) = self.transforms.iter().find(|(id, _)| *id == handle.id) {
                    handle.put(*transform);
                }
                let keyed = self.curves.iter().find(|(id, _)| *id == handle.id);
                let own = handle.line.as_ref().and_then(HandleLine::curve);
                let curve = keyed.map(|(_, curve)| curve.clone()).or_else(|| Some(own?.part(share)));
                if let Some(curve) = curve {
                    handle.line = Some(HandleLine::Curve(curve));
                }
            }
        });
        document.forget_strength();
        if let Some((name, examples)) = self.weights {
            let mut attachments = document.attachments().clone();
            attachments.insert(name, examples);
            document.set_attachments(Arc::new(attachments));
        }
        if let Some(share) = self.strength {
            document.take_part(share);
        }
    }

    /// Returns true if another share than that of the keys is shown: the whole, if handles alone have keys.
    pub(crate) fn is_other_share(&self) -> bool {
        self.is_other_share
    }
}
