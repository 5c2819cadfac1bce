//! The handles of a document over time.

use super::track::{Key, Track};
use crate::document::{Animation, Handle, HandleId, HandleTransform, KeyFrame, SplitTransform};

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

/// The transforms about their pivots that handles with keys have at a time in seconds.
pub(crate) fn poses_at(animation: &Animation, handles: &[Handle], time: f64) -> Vec<(HandleId, HandleTransform)> {
    let posed = |handle: &Handle| {
        let transform = track(animation.keys(), handle.id)?.at(time)?;
        Some((handle.id, transform.about(handle.pivot)))
    };
    handles.iter().filter_map(posed).collect()
}
