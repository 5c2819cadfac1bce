//! The keys of a document as those of an edit, and back.

use glam::DVec3;

use super::edit_error::EditError;
use super::edit_file::EditFile;
use super::keys::KeyEntry;
use super::pivoted::{pivoted, without_pivot};
use super::setup::Setup;
use crate::HandleTransform;
use crate::document::{Animation, Document, HandleId, KeyFrame, Placed, Stance, followed};
use crate::timeline::poses_at;

/// The document's keys of handles, which are in the edit.
pub(super) fn entries(document: &Document, handles: &[HandleId]) -> Vec<KeyEntry> {
    let entry = |key: &KeyFrame| {
        let named = handles.iter().filter_map(|id| {
            let placed = key.handles.get(id)?;
            let transform = pivoted(placed.stance.transform, Some(placed.pivot));
            Some((document.handle(*id)?.name.clone(), transform))
        });
        KeyEntry {
            time: Some(key.time),
            ease: key.ease,
            handles: named.collect(),
            ..KeyEntry::default()
        }
    };
    document.animation().keys().iter().map(entry).collect()
}

/// Gives a document of the edit the edit's keys, and moves its handles to their positions at time 0.
///
/// # Errors
/// Those of [`EditFile::timed_keys`].
pub(super) fn take_keys(document: &mut Document, edit: &EditFile, setup: &Setup) -> Result<(), EditError> {
    let id = |handle: usize| HandleId(handle as u16);
    let placed = |handle: usize, transform: &HandleTransform| {
        let pivot = transform.pivot_or(setup.handles[handle].pivot);
        let transform = without_pivot(transform.part(edit.strength, pivot));
        let turn_deg = match transform {
            HandleTransform::Trs { rotation, .. } => followed(DVec3::ZERO, rotation),
            HandleTransform::Matrix(_) => DVec3::ZERO,
        };
        let stance = Stance { transform, turn_deg };
        Placed { stance, pivot }
    };
    let keys = edit.timed_keys()?.into_iter().map(|key| {
        let handles = key.handles.iter();
        KeyFrame {
            time: key.time,
            ease: key.ease,
            handles: handles
                .map(|(handle, transform)| (id(*handle), placed(*handle, transform)))
                .collect(),
        }
    });
    let own = Animation::default();
    document.set_animation(Animation::of(keys, own.time(), own.fps()));
    let posed = poses_at(document.animation(), document.handles(), own.time());
    document.change_handles(|handles| {
        for (id, transform) in posed {
            if let Some(handle) = handles.iter_mut().find(|handle| handle.id == id) {
                handle.put(transform);
            }
        }
    });
    Ok(())
}
