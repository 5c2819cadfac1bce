//! Commands that set keys at the shown moment.

use super::animation::outside_work_pose;
use super::entry::{Action, Entry, Reason, Scope, State, alt, character, item, unless};
use crate::workspace::{key_here, key_pose, key_strength, key_weights};

/// Sets a key of every handle.
pub(super) const KEY_HERE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Key here",
        "Sets a key of every handle at the shown moment, at its present position.",
        "animation keyframe insert record",
        &[character('i')],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        let mut handles = state.workspace.document.handles().iter();
        let has_handle = handles.any(|handle| !handle.is_pin);
        outside_work_pose(state).or(unless(
            has_handle,
            "There is no handle to set a key of: paint a handle first.",
        ))
    },
    action: Action::Do(|context, ()| key_here(context.workspace, |_| true)),
};

/// Sets a key of the selected handles.
pub(super) const KEY_SELECTED: Entry<()> = Entry {
    listed: &[item(
        (),
        "Key selected handles",
        "Sets a key of the selected handles alone, at the shown moment.",
        "animation keyframe insert record",
        &[alt('i')],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        outside_work_pose(state).or_else(|| {
            let handle = state.selected();
            let is_pin = handle.as_ref().is_ok_and(|handle| handle.is_pin);
            let pin = "A pin does not move, so it has no keys: unpin it first.";
            handle.err().or(unless(!is_pin, pin))
        })
    },
    action: Action::Do(|context, ()| {
        let selection = &context.workspace.selection;
        let mut selected = selection.companions().to_vec();
        selected.extend(selection.selected());
        key_here(context.workspace, |id| selected.contains(&id));
    }),
};

/// Sets a key of the strength.
pub(super) const KEY_STRENGTH: Entry<()> = Entry {
    listed: &[item(
        (),
        "Key strength",
        "Sets a key of the strength alone: the share of the edit that is shown at this moment. Handles keep their own \
         keys.",
        "animation keyframe amount intensity share fade",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        let document = &state.workspace.document;
        outside_work_pose(state).or(unless_frames(state)).or(unless(
            document.is_displaced() || document.strength() != 1.0 || !document.animation().keys().is_empty(),
            "Nothing is bent yet, so there is no share of it: move a handle first.",
        ))
    },
    action: Action::Do(|context, ()| key_strength(context.workspace)),
};

/// Sets a key of the weights of examples.
pub(super) const KEY_WEIGHTS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Key weights",
        "Sets a key of the weights of examples alone, at the shown moment. Handles keep their own keys.",
        "animation keyframe examples blend shapes",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        let document = &state.workspace.document;
        let has_weights = document.examples().is_some() && document.method().examples_bend();
        outside_work_pose(state).or(unless_frames(state)).or(unless(
            has_weights,
            "No example bends the surface: choose a method with examples and add one first.",
        ))
    },
    action: Action::Do(|context, ()| key_weights(context.workspace)),
};

/// Sets a key from a pose, by its place in the list.
pub(super) const KEY_POSE: Entry<usize> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, place| {
        let poses = state.workspace.document.poses();
        outside_work_pose(state).or(unless(*place < poses.len(), "This pose no longer exists."))
    },
    action: Action::Do(|context, place| key_pose(context.workspace, place)),
};

/// The reason why keys that only an edit of one shape has are unavailable in a sequence.
fn unless_frames(state: &State<'_>) -> Option<Reason> {
    unless(
        state.workspace.document.animation().frames().is_none(),
        "Only handles have keys at frames of a sequence: the edit's strength is the same in all of them.",
    )
}
