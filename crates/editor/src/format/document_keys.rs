//! The keys of a document as those of an edit, and back.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::edit_error::EditError;
use super::edit_file::EditFile;
use super::filters::FilterEntry;
use super::footprints::FootprintEntry;
use super::keys::{CurveKey, KeyEntry};
use super::mix::MixEntry;
use super::pivoted::{pivoted, without_pivot};
use super::setup::Setup;
use crate::HandleTransform;
use crate::document::{Animation, Document, HandleId, KeyFrame, Placed, Stance, followed};
use crate::timeline::Posed;

/// The document's keys of handles, which are in the edit.
pub(super) fn entries(document: &Document, handles: &[HandleId]) -> Vec<KeyEntry> {
    if document.animation().frames().is_some() {
        return frame_entries(document, handles);
    }
    let entry = |key: &KeyFrame| {
        let named = handles.iter().filter_map(|id| {
            let placed = key.handles.get(id)?;
            let transform = pivoted(placed.stance.transform, Some(placed.pivot));
            Some((document.handle(*id)?.name.clone(), transform))
        });
        let curves = handles.iter().filter_map(|id| {
            let (handle, curve) = (document.handle(*id)?, key.curves.get(id)?);
            let present = handle.line.as_ref()?.curve()?;
            (present.rest() == curve.rest()).then(|| (handle.name.clone(), CurveKey::of(curve)))
        });
        let count = document.examples().map(|examples| examples.weights.len());
        KeyEntry {
            time: Some(key.time),
            ease: key.ease,
            handles: named.collect(),
            curves: curves.collect(),
            weights: key.weights.clone().filter(|weights| Some(weights.len()) == count),
            strength: key.strength,
            ..KeyEntry::default()
        }
    };
    document.animation().keys().iter().map(entry).collect()
}

/// The keys at frames of a sequence: one for each span that begins at the same frame.
fn frame_entries(document: &Document, handles: &[HandleId]) -> Vec<KeyEntry> {
    let animation = document.animation();
    let mut entries: Vec<KeyEntry> = Vec::new();
    for key in animation.keys() {
        let frame = animation.frame_of(key) as u32;
        for id in handles {
            let (Some(placed), Some(span), Some(handle)) = (key.handles.get(id), key.span(*id), document.handle(*id))
            else {
                continue;
            };
            let span = Some(span.map(|end| end as u32));
            let transform = pivoted(placed.stance.transform, Some(placed.pivot));
            let space = key.space(*id);
            let is_same =
                |entry: &&mut KeyEntry| entry.frame == Some(frame) && entry.span == span && entry.space == space;
            match entries.iter_mut().find(is_same) {
                Some(entry) => drop(entry.handles.insert(handle.name.clone(), transform)),
                None => entries.push(KeyEntry {
                    frame: Some(frame),
                    span,
                    space,
                    ease: key.ease,
                    handles: BTreeMap::from([(handle.name.clone(), transform)]),
                    ..KeyEntry::default()
                }),
            }
        }
    }
    entries
}

/// The filters of the document's handles, which are in the edit.
pub(super) fn filters(document: &Document, handles: &[HandleId]) -> Vec<FilterEntry> {
    let filters = document.animation().filters();
    let entry = |id: &HandleId| Some(FilterEntry::of(&document.handle(*id)?.name, filters.get(id)?));
    handles.iter().filter_map(entry).collect()
}

/// The footprints of the document's handles, which are in the edit.
pub(super) fn footprints(document: &Document, handles: &[HandleId]) -> Vec<FootprintEntry> {
    let footprints = document.animation().footprints();
    let entry = |id: &HandleId| Some(FootprintEntry::of(&document.handle(*id)?.name, footprints.get(id)?));
    handles.iter().filter_map(entry).collect()
}

/// The sequence that leads the document's handles that are in the edit.
pub(super) fn mix(document: &Document, handles: &[HandleId]) -> Option<MixEntry> {
    let mix = document.animation().mix()?;
    let name = |id: HandleId| Some(document.handle(id).filter(|_| handles.contains(&id))?.name.clone());
    MixEntry::of(mix, name)
}

/// The position of a handle by a key's transform about this pivot.
pub(super) fn placed(transform: HandleTransform, pivot: DVec3) -> Placed {
    let transform = without_pivot(transform);
    let turn_deg = match transform {
        HandleTransform::Trs { rotation, .. } => followed(DVec3::ZERO, rotation),
        HandleTransform::Matrix(_) => DVec3::ZERO,
    };
    let stance = Stance { transform, turn_deg };
    Placed { stance, pivot }
}

/// Gives a document of the edit the edit's keys, and moves its handles to their positions at time 0.
///
/// # Errors
/// Those of [`EditFile::timed_keys`].
pub(super) fn take_keys(document: &mut Document, edit: &EditFile, setup: &Setup) -> Result<(), EditError> {
    let id = |handle: usize| HandleId(handle as u16);
    if edit.keys.iter().any(|key| key.time.is_some()) {
        // Everything that makes no timeline is refused.
        edit.timeline(setup)?;
    }
    // Keys of the strength are instead of the edit's own; without them that is made of every key.
    let share = edit.part_before_keys();
    let placed = |handle: usize, transform: &HandleTransform| {
        let pivot = transform.pivot_or(setup.handles[handle].pivot);
        placed(transform.part(share, pivot), pivot)
    };
    let keys = edit.timed_keys(setup)?.into_iter().map(|key| {
        let handles = key.handles.iter();
        KeyFrame {
            time: key.time,
            ease: key.ease,
            handles: handles
                .map(|(handle, transform)| (id(*handle), placed(*handle, transform)))
                .collect(),
            curves: key
                .curves
                .iter()
                .map(|(handle, curve)| (id(*handle), curve.part(share)))
                .collect(),
            spans: BTreeMap::new(),
            in_world: BTreeSet::new(),
            weights: key.weights.map(<[_]>::to_vec).map(|mut weights| {
                if setup.method.examples_bend() {
                    weights.iter_mut().flatten().for_each(|weight| *weight *= share);
                }
                weights
            }),
            strength: key.strength,
        }
    });
    let own = Animation::default();
    document.set_animation(Animation::of(keys, own.time(), own.fps()));
    Posed::at(document.animation(), document, own.time()).put(document);
    Ok(())
}
