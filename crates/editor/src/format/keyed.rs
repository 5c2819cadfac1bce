//! An edit's keys on a model: the timeline of its handles.

use super::edit_error::{EditError, remedy};
use super::edit_file::EditFile;
use super::keys::KeyEntry;
use super::setup::Setup;
use crate::HandleTransform;
use crate::bending::Targets;
use crate::document::SplitTransform;
use crate::ease::Ease;
use crate::timeline::{Key, Timeline, Track};
use crate::warning::shortened;

/// A key of an edit: its time in seconds, the way to the next, and transforms by the handles' places in the list.
pub(super) struct TimedKey {
    pub(super) time: f64,
    pub(super) ease: Ease,
    pub(super) handles: Vec<(usize, HandleTransform)>,
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
        let keys = self.timed_keys()?;
        let mut of_handle: Vec<Vec<Key>> = vec![Vec::new(); self.handles.len()];
        for key in &keys {
            for (handle, transform) in &key.handles {
                let pivot = setup.handles[*handle].pivot;
                of_handle[*handle].push(Key {
                    time: key.time,
                    ease: key.ease,
                    transform: SplitTransform::of(&transform.part(self.strength, pivot), pivot),
                });
            }
        }
        let duration = keys.last().map_or(0.0, |key| key.time);
        Ok(Timeline::new(of_handle.into_iter().map(Track::new).collect(), duration))
    }

    /// Its keys, by time.
    ///
    /// # Errors
    /// Members that are for sequences, a name that no handle has, a name that two handles have.
    pub(super) fn timed_keys(&self) -> Result<Vec<TimedKey>, EditError> {
        let others = [
            ("filter", self.filter.is_empty()),
            ("footprints", self.footprints.is_empty()),
        ];
        if let Some((member, _)) = others.into_iter().find(|(_, is_empty)| !is_empty) {
            return Err(EditError::Other {
                place: "the edit".to_owned(),
                sentence: format!("has `{member}`, and that is for sequences: use `pliant sequence`, or remove it"),
            });
        }
        let names: Vec<&str> = self.handles.iter().map(|handle| &*handle.name).collect();
        let timed = |(place, key): (usize, &KeyEntry)| {
            let Some(time) = key.time else {
                return Err(EditError::Other {
                    place: format!("keys[{place}]"),
                    sentence: "has the `frame` of a sequence, not a `time`: use `pliant sequence`, or give it a time"
                        .to_owned(),
                });
            };
            let named = key.handles.iter().map(|(name, transform)| {
                let handle = handle_of(name, &names).map_err(|error| error.under(&format!("keys[{place}].handles")))?;
                Ok((handle, *transform))
            });
            Ok(TimedKey {
                time,
                ease: key.ease,
                handles: named.collect::<Result<_, EditError>>()?,
            })
        };
        let timed: Result<Vec<TimedKey>, EditError> = self.keys.iter().enumerate().map(timed).collect();
        let mut keys = timed?;
        keys.sort_by(|a, b| a.time.total_cmp(&b.time));
        Ok(keys)
    }
}

impl Setup {
    /// The targets at a time of a timeline, in seconds. Control points and weights of examples are those of
    /// the edit, and keys hold a free handle.
    pub fn targets_during(&self, timeline: &Timeline, time: f64) -> Targets {
        let targets = self.targets_of(timeline.maps_at(time, self.targets(1.0)));
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
