//! An edit's keys on a model: the timeline of its handles.

use super::edit_error::{EditError, remedy};
use super::edit_file::EditFile;
use super::keys::KeyEntry;
use super::setup::Setup;
use crate::bending::Targets;
use crate::document::SplitTransform;
use crate::timeline::{Key, Timeline, Track};
use crate::warning::shortened;

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
        let timed = |(place, key): (usize, &'_ KeyEntry)| match key.time {
            Some(time) => Ok((place, time)),
            None => Err(EditError::Other {
                place: format!("keys[{place}]"),
                sentence: "has the `frame` of a sequence, not a `time`: use `pliant sequence`, or give it a time"
                    .to_owned(),
            }),
        };
        let timed: Result<Vec<(usize, f64)>, EditError> = self.keys.iter().enumerate().map(timed).collect();
        let mut keys = timed?;
        keys.sort_by(|(_, a), (_, b)| a.total_cmp(b));
        let mut of_handle: Vec<Vec<Key>> = vec![Vec::new(); names.len()];
        for &(place, time) in &keys {
            let key = &self.keys[place];
            for (name, transform) in &key.handles {
                let handle = handle_of(name, &names).map_err(|error| error.under(&format!("keys[{place}].handles")))?;
                let pivot = setup.handles[handle].pivot;
                of_handle[handle].push(Key {
                    time,
                    ease: key.ease,
                    transform: SplitTransform::of(&transform.part(self.strength, pivot), pivot),
                });
            }
        }
        let duration = keys.last().map_or(0.0, |(_, time)| *time);
        Ok(Timeline::new(of_handle.into_iter().map(Track::new).collect(), duration))
    }
}

impl Setup {
    /// The targets at a time of a timeline, in seconds. Control points and weights of examples are those of the edit.
    pub fn targets_during(&self, timeline: &Timeline, time: f64) -> Targets {
        self.targets_of(timeline.maps_at(time, self.targets(1.0)))
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
