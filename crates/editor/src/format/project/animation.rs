//! The edit over time in a project.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::place::{StoredPlace, places, stored_places};
use crate::document::{Animation, HandleCurve, HandleId, KeyFrame};
use crate::ease::Ease;
use crate::format::edit_error::EditError;
use crate::format::filters::{FilterEntry, check_filters};
use crate::format::footprints::{FootprintEntry, check_footprints};
use crate::format::mix::MixEntry;
use crate::format::path::PathEntry;
use crate::format::strength::strength_kind;

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredAnimation {
    /// The frames a second.
    fps: f64,
    /// The shown moment, in seconds.
    #[serde(default)]
    time: f64,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    keys: Vec<StoredKey>,
    /// The bent path of the body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    path: Option<PathEntry>,
    /// The filters of handles' ways; each names its handle by its number.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    filter: Vec<FilterEntry>,
    /// The footprints of handles; each names its handle by its number.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    footprints: Vec<FootprintEntry>,
    /// The sequence that leads handles, which it names by their numbers; its path is like the mesh's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) mix: Option<MixEntry>,
}

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredKey {
    /// In seconds.
    time: f64,
    #[serde(default)]
    ease: Ease,
    /// The positions, by the handles' numbers.
    handles: BTreeMap<u32, StoredPlace>,
    /// The curves, by the handles' numbers.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    curves: BTreeMap<u32, HandleCurve>,
    /// The first and the last frame of each key's span in a sequence, by the handles' numbers.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    spans: BTreeMap<u32, [usize; 2]>,
    /// The handles whose keys in a sequence stay the same to the world's axes, by their numbers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    in_world: Vec<u32>,
    /// The weights of the examples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weights: Option<Vec<Option<f64>>>,
    /// The share of the edit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    strength: Option<f64>,
}

impl StoredAnimation {
    /// `None` for an edit without keys that shows its beginning.
    pub(super) fn of(animation: &Animation) -> Option<Self> {
        if *animation == Animation::default() {
            return None;
        }
        let key = |key: &KeyFrame| StoredKey {
            time: key.time,
            ease: key.ease,
            handles: stored_places(&key.handles),
            curves: key
                .curves
                .iter()
                .map(|(id, curve)| (u32::from(id.0), curve.clone()))
                .collect(),
            spans: key.spans.iter().map(|(id, span)| (u32::from(id.0), *span)).collect(),
            in_world: key.in_world.iter().map(|id| u32::from(id.0)).collect(),
            weights: key.weights.clone(),
            strength: key.strength,
        };
        Some(Self {
            fps: animation.fps(),
            time: animation.time(),
            keys: animation.keys().iter().map(key).collect(),
            path: animation.path().map(|path| PathEntry::of(path)),
            filter: animation
                .filters()
                .iter()
                .map(|(id, filter)| FilterEntry::of(&id.0.to_string(), filter))
                .collect(),
            footprints: animation
                .footprints()
                .iter()
                .map(|(id, footprints)| FootprintEntry::of(&id.0.to_string(), footprints))
                .collect(),
            mix: animation
                .mix()
                .and_then(|mix| MixEntry::of(mix, |id| Some(id.0.to_string()))),
        })
    }

    /// The same, read.
    ///
    /// # Errors
    /// A time or a number of frames a second outside its range; a path that an edit can't have.
    pub(super) fn animation(&self) -> Result<Animation, EditError> {
        let refuse = |place: String, found: f64, allowed: String| {
            Err(EditError::OutOfRange {
                place,
                found: found.to_string(),
                allowed,
            })
        };
        let rates = Animation::FPS_RANGE;
        if !rates.contains(&self.fps) {
            let allowed = format!("a number from {} to {}", rates.start(), rates.end());
            return refuse("animation.fps".to_owned(), self.fps, allowed);
        }
        let keyed = self.keys.iter().enumerate();
        let keyed = keyed.map(|(place, key)| (format!("animation.keys[{place}].time"), key.time));
        for (place, time) in keyed.chain([("animation.time".to_owned(), self.time)]) {
            if !(0.0..=Animation::LATEST).contains(&time) {
                return refuse(place, time, format!("seconds from 0 to {}", Animation::LATEST));
            }
        }
        for (place, key) in self.keys.iter().enumerate() {
            if let Some(strength) = key.strength {
                let checked = strength_kind().check(strength);
                checked.map_err(|error| error.under(&format!("animation.keys[{place}].strength")))?;
            }
        }
        let key = |key: &StoredKey| KeyFrame {
            time: key.time,
            ease: key.ease,
            handles: places(&key.handles),
            curves: key
                .curves
                .iter()
                .filter_map(|(id, curve)| Some((HandleId(u16::try_from(*id).ok()?), curve.clone())))
                .collect(),
            spans: key
                .spans
                .iter()
                .filter_map(|(id, span)| Some((HandleId(u16::try_from(*id).ok()?), *span)))
                .collect(),
            in_world: key
                .in_world
                .iter()
                .filter_map(|id| Some(HandleId(u16::try_from(*id).ok()?)))
                .collect(),
            weights: key.weights.clone(),
            strength: key.strength,
        };
        if let Some(path) = &self.path {
            path.check_of_document().map_err(|error| error.under("animation"))?;
        }
        let animation = Animation::of(self.keys.iter().map(key), self.time, self.fps);
        let mut animation = animation.with_path(self.path.as_ref().and_then(PathEntry::path));
        check_filters(&self.filter).map_err(|error| error.under("animation"))?;
        for filter in &self.filter {
            if let Ok(handle) = filter.handle.parse() {
                animation = animation.with_filter(HandleId(handle), Some(filter.filter()));
            }
        }
        check_footprints(&self.footprints).map_err(|error| error.under("animation"))?;
        for footprint in &self.footprints {
            if let Ok(handle) = footprint.handle.parse() {
                animation = animation.with_footprints(HandleId(handle), Some(footprint.footprints()));
            }
        }
        if let Some(mix) = &self.mix {
            mix.check().map_err(|error| error.under("animation"))?;
            let numbers = mix.handles.iter().filter_map(|handle| handle.parse().ok());
            animation = animation.with_mix(Some(mix.mix(numbers.map(HandleId).collect())));
        }
        Ok(animation)
    }
}
