//! Handles at a frame of a sequence, by the keys of a document.

use glam::DVec3;

use super::span::{HandlePlace, Span, SpanKey};
use crate::document::{Animation, Handle, HandleTransform, KeyFrame, SplitTransform};

/// The frames of the keys that reach a frame: the places of their handles are needed there.
pub(crate) fn frames_that_reach(animation: &Animation, handles: &[Handle], frame: usize) -> Vec<usize> {
    let spans = handles
        .iter()
        .filter_map(|handle| Some((handle.id, animation.span_at(handle.id, frame)?)));
    let keys = spans.flat_map(|(handle, span)| animation.keys_in(handle, span));
    let mut frames: Vec<usize> = keys.map(|(frame, _)| frame).collect();
    frames.sort_unstable();
    frames.dedup();
    frames
}

/// A handle's transform about `pivot` at a frame where it has this place; the identity if no key reaches the frame.
/// `place_at` gives its place in the frames of its keys.
pub(crate) fn transform_at(
    animation: &Animation,
    handle: &Handle,
    (frame, place, pivot): (usize, &HandlePlace, DVec3),
    place_at: impl Fn(usize) -> Option<HandlePlace>,
) -> HandleTransform {
    let span_key = |(frame, key): (usize, &KeyFrame)| {
        let placed = key.handles.get(&handle.id)?;
        Some(SpanKey {
            frame,
            ease: key.ease,
            space: key.space(handle.id),
            place: place_at(frame)?,
            transform: SplitTransform::of(&placed.stance.transform, placed.pivot),
        })
    };
    let span = animation.span_at(handle.id, frame).map(|ends| Span {
        ends,
        keys: animation.keys_in(handle.id, ends).filter_map(span_key).collect(),
    });
    let transform = span.and_then(|span| span.at(frame, place));
    transform.map_or(HandleTransform::IDENTITY, |transform| transform.about(pivot))
}
