//! The key of the shown moment, with everything as it is shown.

use super::posed::Posed;
use crate::document::{Document, Handle, HandleId, HandleLine, KeyFrame, Placed};

/// The present transforms and curves of the handles that are wanted, pins apart, and the weights of examples that bend
/// the surface. If the shown ones are a share of an edit, the key has the shown ones; if the strength has keys, it has the
/// whole ones. Another share than that of the keys is keyed, too, with all handles, because it moves all of them.
pub(crate) fn present_key(document: &Document, is_wanted: impl Fn(HandleId) -> bool) -> KeyFrame {
    let animation = document.animation();
    if !animation.has_strength() {
        return shown_key(document, is_wanted);
    }
    let is_other_share = Posed::at(animation, document, animation.time()).is_other_share();
    KeyFrame {
        strength: is_other_share.then(|| document.strength()),
        ..shown_key(&document.in_full(), |id| is_other_share || is_wanted(id))
    }
}

/// The key of the shown positions.
fn shown_key(document: &Document, is_wanted: impl Fn(HandleId) -> bool) -> KeyFrame {
    let wanted = || {
        let handles = document.handles().iter();
        handles.filter(|handle| !handle.is_pin && is_wanted(handle.id))
    };
    let share = document.strength();
    let curves = wanted().filter_map(|handle| {
        let curve = handle.line.as_ref().and_then(HandleLine::curve)?;
        Some((handle.id, curve.part(share)))
    });
    if document.animation().frames().is_some() {
        return frame_key(document, wanted().collect());
    }
    let examples = document.examples().filter(|_| document.method().examples_bend());
    KeyFrame {
        time: document.animation().time(),
        handles: wanted().map(|handle| (handle.id, Placed::of(handle))).collect(),
        curves: curves.collect(),
        weights: examples.map(|examples| examples.weights.clone()),
        ..KeyFrame::default()
    }
}

/// The key of a sequence's shown frame: the transforms of those handles that are moved there, or that have a span around
/// it; of all if there are none.
fn frame_key(document: &Document, handles: Vec<&Handle>) -> KeyFrame {
    let animation = document.animation();
    let is_moved =
        |handle: &&&Handle| handle.is_displaced() || animation.span_at(handle.id, animation.frame()).is_some();
    let moved: Vec<&Handle> = handles.iter().filter(is_moved).copied().collect();
    let keyed = if moved.is_empty() { handles } else { moved };
    KeyFrame {
        time: animation.time(),
        handles: keyed
            .into_iter()
            .map(|handle| (handle.id, Placed::of(handle)))
            .collect(),
        ..KeyFrame::default()
    }
}
