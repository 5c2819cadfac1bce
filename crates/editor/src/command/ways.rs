//! Commands on the ways through a sequence: the body's path, and the filters and footprints of handles.

use glam::DVec3;

use super::entry::{Action, Entry, Reason, Scope, State, item, unless};
use crate::document::{Animation, HandleFilter, HandleFootprints, HandleId, HandleMix};
use crate::warning::in_window_words;
use crate::workspace::{bend_path, free_path, set_filter, set_footprints, set_mix};

/// Shows or hides the path of a sequence's body.
pub(super) const TOGGLE_PATH: Entry<()> = Entry {
    listed: &[item(
        (),
        "Path of the body",
        "Shows or hides the way of the whole body through a sequence: drag it in the view to bend it.",
        "animation trajectory walk route bend ground",
        &[],
    )],
    scope: Scope::View,
    unavailable: |state, ()| no_sequence(state),
    action: Action::Do(|context, ()| {
        let look = &mut context.view.look;
        look.path = !(look.path && look.timeline);
        look.timeline |= look.path;
        context.workspace.try_to_follow_again();
    }),
};

/// Moves a sequence's body at a frame.
pub(super) const BEND_PATH: Entry<(usize, DVec3)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (frame, shift)| {
        let count = state.workspace.document.animation().frames().unwrap_or_default();
        let is_way = *frame < count && shift.is_finite();
        no_sequence(state).or(unless(is_way, "The sequence does not have this frame."))
    },
    action: Action::Do(|context, (frame, shift)| {
        let up = context.view.camera().up;
        bend_path(context.workspace, frame, shift, up);
    }),
};

/// No longer moves a sequence's body at a frame.
pub(super) const FREE_PATH: Entry<usize> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, frame| {
        let path = state.workspace.document.animation().path();
        let has_point = path.is_some_and(|path| path.has(*frame));
        no_sequence(state).or(unless(has_point, "The path is not moved at this frame."))
    },
    action: Action::Do(|context, frame| free_path(context.workspace, frame)),
};

/// Filters a handle's way through a sequence, or no longer.
pub(super) const SET_FILTER: Entry<(HandleId, Option<HandleFilter>)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (id, filter)| {
        let count = state.workspace.document.animation().frames().unwrap_or_default();
        let is_usable = filter.is_none_or(|filter| filter.is_usable(count));
        let is_moved = filter.and_then(|_| {
            let animation = state.workspace.document.animation();
            held_by_footprints(animation, *id).or_else(|| led(animation, *id))
        });
        no_sequence(state).or_else(|| state.gone(*id)).or(is_moved).or(unless(
            is_usable,
            "A filter has frames of the sequence, a width of .1 to 1000 and an amount of 0 to 10.",
        ))
    },
    action: Action::Do(|context, (id, filter)| set_filter(context.workspace, id, filter)),
};

/// Holds a handle of a sequence wherever it rests on the ground, or no longer.
pub(super) const SET_FOOTPRINTS: Entry<(HandleId, Option<HandleFootprints>)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (id, footprints)| {
        if footprints.is_none() {
            return no_sequence(state);
        }
        let animation = state.workspace.document.animation();
        let are_usable = footprints.is_none_or(|footprints| footprints.are_usable());
        let unusable = "The height and the speed of footprints are above 0.";
        no_sequence(state)
            .or_else(|| state.gone(*id))
            .or_else(|| keyed_or_filtered(animation, *id))
            .or_else(|| led(animation, *id))
            .or_else(|| takes_no_places(state))
            .or(unless(are_usable, unusable))
    },
    action: Action::Do(|context, (id, footprints)| set_footprints(context.workspace, id, footprints)),
};

/// Lets another sequence lead handles, or none.
pub(super) const SET_MIX: Entry<Option<HandleMix>> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, mix| {
        let animation = state.workspace.document.animation();
        let of_handle =
            |id: &HandleId| keyed_or_filtered(animation, *id).or_else(|| held_by_footprints(animation, *id));
        let handles = || mix.iter().flat_map(|mix| &mix.handles);
        let is_share = mix
            .as_ref()
            .is_none_or(|mix| HandleMix::SHARE_RANGE.contains(&mix.share));
        no_sequence(state)
            .or_else(|| handles().find_map(of_handle))
            .or(unless(is_share, "The share of a mix is from 0 to 1."))
    },
    action: Action::Do(|context, mix| set_mix(context.workspace, mix)),
};

/// The reason if the method can't hold each vertex of a handle at its own place.
fn takes_no_places(state: &State<'_>) -> Option<Reason> {
    let refusal = HandleFootprints::refusal_by(state.workspace.document.method())?;
    Some(in_window_words(&format!("{refusal}.")).into())
}

/// The reason if a key or a filter moves a handle.
fn keyed_or_filtered(animation: &Animation, id: HandleId) -> Option<Reason> {
    let is_keyed = animation.keys().iter().any(|key| key.has(id));
    let is_moved = is_keyed || animation.filters().contains_key(&id);
    let moved = "A key or a filter moves this handle: remove it first, or paint another handle.";
    unless(!is_moved, moved)
}

/// The reason if footprints hold a handle.
fn held_by_footprints(animation: &Animation, id: HandleId) -> Option<Reason> {
    let is_held = animation.footprints().contains_key(&id);
    unless(!is_held, "Footprints hold this handle: remove them first.")
}

/// The reason if another sequence leads a handle.
fn led(animation: &Animation, id: HandleId) -> Option<Reason> {
    let is_led = animation.mix().is_some_and(|mix| mix.leads(id));
    unless(!is_led, "Another sequence leads this handle: choose its own way first.")
}

/// The reason if no sequence is open.
fn no_sequence(state: &State<'_>) -> Option<Reason> {
    let is_sequence = state.workspace.document.animation().frames().is_some();
    let none = "A single shape has no way through frames: open a sequence.";
    state
        .unopened()
        .or_else(|| state.in_work_pose())
        .or(unless(is_sequence, none))
}
