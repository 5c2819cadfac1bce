//! An edit's keys on a model: the timeline of its handles.

use super::edit_error::{EditError, remedy};
use super::edit_file::EditFile;
use super::keys::KeyEntry;
use super::setup::{HandleSetup, Setup};
use crate::HandleTransform;
use crate::bending::Targets;
use crate::document::{HandleCurve, HandleLine, SplitTransform};
use crate::ease::Ease;
use crate::timeline::{Key, NumberTrack, Timeline, Track, Values, values_of};
use crate::warning::shortened;

/// A key of an edit: its time in seconds, the way to the next, transforms and curves by the handles' places in the list,
/// and the weights and the strength that it has.
pub(super) struct TimedKey<'a> {
    pub(super) time: f64,
    pub(super) ease: Ease,
    pub(super) handles: Vec<(usize, HandleTransform)>,
    pub(super) curves: Vec<(usize, HandleCurve)>,
    pub(super) weights: Option<&'a [Option<f64>]>,
    pub(super) strength: Option<f64>,
}

impl EditFile {
    /// The motions of its handles on the model of `setup`, on which it was resolved.
    ///
    /// # Errors
    /// No keys, a name that no handle has, a name that two handles have.
    pub fn timeline(&self, setup: &Setup) -> Result<Timeline, EditError> {
        if self.keys.is_empty() {
            return Err(EditError::Missing {
                member: "keys",
                place: "the edit".to_owned(),
            });
        }
        let keys = self.timed_keys(setup)?;
        let part = self.part_before_keys();
        let mut of_handle: Vec<Vec<Key>> = vec![Vec::new(); self.handles.len()];
        for key in &keys {
            for (handle, transform) in &key.handles {
                let pivot = setup.handles[*handle].pivot;
                of_handle[*handle].push(Key {
                    time: key.time,
                    ease: key.ease,
                    transform: SplitTransform::of(&transform.part(part, pivot), pivot),
                });
            }
        }
        let curve = |(handle, own): (usize, &HandleSetup)| {
            let of_key = |key: &TimedKey<'_>| {
                let (_, curve) = key.curves.iter().find(|(own, _)| *own == handle)?;
                Some((key.time, key.ease, values_of(curve)))
            };
            let track = NumberTrack::new(keys.iter().filter_map(of_key).collect());
            let curve = own.line.as_ref()?.curve()?.clone();
            (!track.is_empty()).then_some((handle, curve, track))
        };
        let numbers = |of: &dyn Fn(&TimedKey<'_>) -> Option<Vec<f64>>| {
            let keyed = keys.iter().filter_map(|key| {
                let values = Values {
                    numbers: of(key)?,
                    vectors: Vec::new(),
                };
                Some((key.time, key.ease, values))
            });
            NumberTrack::new(keyed.collect())
        };
        let weights = |key: &TimedKey<'_>| {
            let weights = key.weights?.iter();
            Some(weights.map(|weight| weight.unwrap_or(f64::NAN)).collect())
        };
        if let Some((place, found)) = (0..)
            .zip(&self.keys)
            .filter_map(|(place, key)| Some((place, key.weights.as_ref()?.len())))
            .find(|(_, found)| *found != setup.examples().map_or(0, |examples| examples.shapes.len()))
        {
            let count = setup.examples().map_or(0, |examples| examples.shapes.len());
            let place: usize = place;
            return Err(EditError::Other {
                place: format!("keys[{place}]"),
                sentence: format!("has {found} `weights`, but the method has {count} examples: give one for each"),
            });
        }
        Ok(Timeline {
            tracks: of_handle.into_iter().map(Track::new).collect(),
            curves: setup.handles.iter().enumerate().filter_map(curve).collect(),
            weights: numbers(&weights),
            strength: numbers(&|key| Some(vec![key.strength?])),
            duration: keys.last().map_or(0.0, |key| key.time),
        })
    }

    /// The share of the edit that does not change over time: the keys' own shares are instead of it.
    pub(super) fn part_before_keys(&self) -> f64 {
        match self.keys.iter().any(|key| key.strength.is_some()) {
            true => 1.0,
            false => self.strength,
        }
    }

    /// Its keys, by time, on the model of `setup`.
    ///
    /// # Errors
    /// Members that are for sequences, a name that no handle has, a name that two handles have.
    pub(super) fn timed_keys(&self, setup: &Setup) -> Result<Vec<TimedKey<'_>>, EditError> {
        if let Some(member) = self.member_of_sequences() {
            return Err(EditError::Other {
                place: "the edit".to_owned(),
                sentence: format!("has `{member}`, and that is for sequences: use `pliant sequence`, or remove it"),
            });
        }
        let names = self.names();
        let timed: Result<Vec<TimedKey<'_>>, EditError> = self
            .keys
            .iter()
            .enumerate()
            .map(|(place, key)| timed_key(setup, place, key, &names))
            .collect();
        let mut keys = timed?;
        keys.sort_by(|a, b| a.time.total_cmp(&b.time));
        Ok(keys)
    }
}

impl Setup {
    /// The targets at a time of a timeline, in seconds. Control points are those of the edit, and so is everything that
    /// has no keys; a free handle with keys is held by them.
    pub fn targets_during(&self, timeline: &Timeline, time: f64) -> Targets {
        let share = timeline.strength_at(time);
        let keyed = timeline.transforms_at(time).zip(&self.handles).zip(self.targets(share));
        let maps = keyed.map(|((transform, handle), own)| match transform {
            None => own,
            Some(transform) if share == 1.0 => transform.affine(),
            Some(transform) => {
                let part = transform.about(handle.pivot).part(share, handle.pivot);
                part.affine(handle.pivot)
            }
        });
        let targets = self.targets_with(
            maps.collect(),
            timeline.weights_at(time),
            &timeline.curves_at(time),
            share,
        );
        let free_along = self.handles.iter().enumerate();
        let free_along = free_along.map(|(place, handle)| handle.free_along.filter(|_| !timeline.is_keyed(place)));
        targets.free_along(free_along.collect())
    }
}

/// The place of the one handle with a name.
pub(super) fn handle_of(name: &str, names: &[&str]) -> Result<usize, EditError> {
    let mut places = (0..names.len()).filter(|&place| names[place] == name);
    match (places.next(), places.next()) {
        (Some(place), None) => Ok(place),
        (None, _) => Err(EditError::UnknownName {
            name: shortened(name),
            place: String::new(),
            remedy: remedy(name, names),
        }),
        (Some(_), Some(_)) => Err(EditError::Other {
            place: String::new(),
            sentence: format!(
                "moves `{}`, but two handles have this name: give each a name of its own",
                shortened(name)
            ),
        }),
    }
}

fn timed_key<'a>(setup: &Setup, place: usize, key: &'a KeyEntry, names: &[&str]) -> Result<TimedKey<'a>, EditError> {
    let Some(time) = key.time else {
        return Err(EditError::Other {
            place: format!("keys[{place}]"),
            sentence: "has the `frame` of a sequence, not a `time`: use `pliant sequence`, or give it a time"
                .to_owned(),
        });
    };
    let named = key.handles.iter().map(|(name, transform)| {
        let handle = handle_of(name, names).map_err(|error| error.under(&format!("keys[{place}].handles")))?;
        Ok((handle, *transform))
    });
    let curves = key.curves.iter().map(|(name, curve)| {
        let under = |error: EditError| error.under(&format!("keys[{place}].curves"));
        let handle = handle_of(name, names).map_err(under)?;
        let refuse = |sentence: String| EditError::Other {
            place: format!("keys[{place}].curves.{}", shortened(name)),
            sentence,
        };
        let own = setup.handles[handle].line.as_ref().and_then(HandleLine::curve);
        let own = own.ok_or_else(|| {
            refuse("is of a handle without a `curve`: give the handle one, or remove this".to_owned())
        })?;
        Ok((handle, curve.on(own).map_err(refuse)?))
    });
    Ok(TimedKey {
        time,
        ease: key.ease,
        handles: named.collect::<Result<_, EditError>>()?,
        curves: curves.collect::<Result<_, EditError>>()?,
        weights: key.weights.as_deref(),
        strength: key.strength,
    })
}
