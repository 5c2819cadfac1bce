//! Commands on the edit over time: keys, the shown moment, play.

use super::entry::{Action, Entry, Reason, Scope, State, alt, always, character, ctrl, item, unless};
use crate::document::{Animation, KeyFrame, KeyId};
use crate::ease::Ease;
use crate::key_space::KeySpace;
use crate::view::Skins;
use crate::workspace::{
    copy_keys, delete_keys, go_to, move_keys, neighbour_key, paste_keys, set_fps, set_key_ease, set_key_space,
    set_span, step_frames, stretch_keys,
};

/// Shows or hides the timeline.
pub(super) const TOGGLE_TIMELINE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Timeline",
        "Shows or hides the timeline under the view: the keys of the handles, and the moment that is shown.",
        "animation time keyframes dopesheet strip",
        &[character('t')],
    )],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ()| context.view.look.timeline = !context.view.look.timeline),
};

/// Shows or hides the ghosts of other moments.
pub(super) const TOGGLE_SKINS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Onion skins",
        "Shows or hides ghosts of the moments before and after the shown one, while the timeline is shown.",
        "animation ghosts time trail",
        &[alt('t')],
    )],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ()| {
        let look = &mut context.view.look;
        look.skins.shown = !(look.skins.shown && look.timeline);
        look.timeline |= look.skins.shown;
    }),
};

/// Chooses the ghosts of other moments.
pub(super) const SET_SKINS: Entry<Skins> = Entry {
    listed: &[],
    scope: Scope::View,
    unavailable: |_, skins| {
        unless(
            skins.are_usable(),
            "There are at most 8 onion skins on a side, a frame apart or more.",
        )
    },
    action: Action::Do(|context, skins| context.view.look.skins = skins),
};

/// Shows a moment.
pub(super) const GO_TO_TIME: Entry<f64> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, time| {
        let is_time = (0.0..=Animation::LATEST).contains(time);
        outside_work_pose(state).or(unless(is_time, "A time is from 0 to a week, in seconds."))
    },
    action: Action::Do(|context, time| go_to(context.workspace, time)),
};

/// Shows the moment so many frames later.
pub(super) const STEP_FRAMES: Entry<i32> = Entry {
    listed: &[
        item(
            1,
            "Next frame",
            "Shows the moment a frame later.",
            "animation time step forward",
            &[alt('.')],
        ),
        item(
            -1,
            "Previous frame",
            "Shows the moment a frame earlier.",
            "animation time step back",
            &[alt(',')],
        ),
    ],
    scope: Scope::Document,
    unavailable: |state, _| outside_work_pose(state),
    action: Action::Do(|context, frames| step_frames(context.workspace, frames)),
};

/// Shows the moment of the next key, or of the one before.
pub(super) const GO_TO_KEY: Entry<bool> = Entry {
    listed: &[
        item(
            true,
            "Next key",
            "Shows the moment of the next key.",
            "animation time jump forward",
            &[ctrl('.')],
        ),
        item(
            false,
            "Previous key",
            "Shows the moment of the last key before this one.",
            "animation time jump back",
            &[ctrl(',')],
        ),
    ],
    scope: Scope::Document,
    unavailable: |state, is_forward| {
        outside_work_pose(state).or_else(|| {
            let time = neighbour_key(state.workspace.document.animation(), *is_forward);
            unless(time.is_some(), "There is no key in this direction.")
        })
    },
    action: Action::Do(|context, is_forward| {
        if let Some(time) = neighbour_key(context.workspace.document.animation(), is_forward) {
            go_to(context.workspace, time);
        }
    }),
};

/// Plays, or pauses.
pub(super) const PLAY_KEYS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Play or pause animation",
        "Shows the frames from the first to the last key over and over. Each is solved; none is left out. A stretch of \
         play is one step to undo.",
        "keys run start stop animate",
        &[character('p')],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        let is_moving = state.workspace.document.animation().duration() > 0.0;
        outside_work_pose(state).or(unless(
            is_moving,
            "Nothing moves yet: set keys at two moments of the timeline.",
        ))
    },
    action: Action::Do(|context, ()| context.workspace.play_or_pause_keys()),
};

/// Selects keys.
pub(super) const SELECT_KEYS: Entry<Vec<KeyId>> = Entry {
    listed: &[],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ids| context.workspace.select_keys(ids)),
};

/// Selects every key.
pub(super) const SELECT_ALL_KEYS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Select all keys",
        "Selects every key of the timeline.",
        "animation keyframes",
        &[],
    )],
    scope: Scope::View,
    unavailable: |state, ()| {
        let has_keys = !state.workspace.document.animation().keys().is_empty();
        unless(has_keys, "There are no keys yet: choose *Key here* first.")
    },
    action: Action::Do(|context, ()| context.workspace.select_all_keys()),
};

/// Moves the selected keys by a time.
pub(super) const MOVE_KEYS: Entry<f64> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, by| no_keys(state).or(unless(by.is_finite(), "A time is a number.")),
    action: Action::Do(|context, by| move_keys(context.workspace, by)),
};

/// Stretches the times of the selected keys by a factor.
pub(super) const STRETCH_KEYS: Entry<f64> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, factor| {
        let is_factor = factor.is_finite() && *factor > 0.0;
        no_keys(state).or(unless(is_factor, "A factor of times is above 0."))
    },
    action: Action::Do(|context, factor| stretch_keys(context.workspace, factor)),
};

/// Removes the selected keys.
pub(super) const DELETE_KEYS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Delete keys",
        "Deletes the selected keys. Handles without another key stay where they are.",
        "animation keyframes remove",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| no_keys(state),
    action: Action::Do(|context, ()| delete_keys(context.workspace)),
};

/// Copies the selected keys.
pub(super) const COPY_KEYS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Copy keys",
        "Copies the selected keys, to be pasted at another moment.",
        "animation keyframes duplicate",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| no_keys(state),
    action: Action::Do(|context, ()| copy_keys(context.workspace)),
};

/// Pastes the copied keys.
pub(super) const PASTE_KEYS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Paste keys",
        "Sets the copied keys again, the first of them at the shown moment.",
        "animation keyframes duplicate",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        let has_copied = state.workspace.keys.has_copied();
        outside_work_pose(state).or(unless(has_copied, "No keys were copied: choose *Copy keys* first."))
    },
    action: Action::Do(|context, ()| paste_keys(context.workspace)),
};

/// Gives the selected keys another way to the next.
pub(super) const SET_KEY_EASE: Entry<Ease> = Entry {
    listed: &[
        item(
            Ease::Smooth,
            "Ease: smooth",
            "Moves from the selected keys to the next along a smooth curve through all keys.",
            "animation keyframes interpolation spline",
            &[],
        ),
        item(
            Ease::Linear,
            "Ease: linear",
            "Moves from the selected keys to the next at constant speed.",
            "animation keyframes interpolation straight",
            &[],
        ),
        item(
            Ease::Hold,
            "Ease: hold",
            "Stays at the selected keys until the next.",
            "animation keyframes interpolation constant stepped",
            &[],
        ),
    ],
    scope: Scope::Document,
    unavailable: |state, _| no_keys(state),
    action: Action::Do(|context, ease| set_key_ease(context.workspace, ease)),
};

/// Chooses the axes of the selected keys.
pub(super) const SET_KEY_SPACE: Entry<KeySpace> = Entry {
    listed: &[
        item(
            KeySpace::Local,
            "Keys turn with their handles",
            "Keeps the selected keys of a sequence the same to their handles, which may turn from frame to frame.",
            "animation keyframes space local axes",
            &[],
        ),
        item(
            KeySpace::World,
            "Keys keep the world's axes",
            "Keeps the selected keys of a sequence the same to the world's axes from frame to frame.",
            "animation keyframes space world axes",
            &[],
        ),
    ],
    scope: Scope::Document,
    unavailable: |state, _| {
        let is_sequence = state.workspace.document.animation().frames().is_some();
        no_keys(state).or(unless(
            is_sequence,
            "Only keys of a sequence have axes: their handles turn from frame to frame.",
        ))
    },
    action: Action::Do(|context, space| set_key_space(context.workspace, space)),
};

/// Changes the span of a key.
pub(super) const SET_SPAN: Entry<(KeyId, [usize; 2])> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (id, _)| {
        let animation = state.workspace.document.animation();
        let mut keys = animation.keys().iter();
        let span = |key: &KeyFrame| key.span(id.row.handle()?);
        let has_span = keys.any(|key| key.time == id.time() && span(key).is_some());
        outside_work_pose(state).or(unless(has_span, "This key no longer exists."))
    },
    action: Action::Do(|context, (id, ends)| set_span(context.workspace, id, ends)),
};

/// Chooses the number of frames a second.
pub(super) const SET_FPS: Entry<f64> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, fps| {
        let is_rate = Animation::FPS_RANGE.contains(fps);
        state
            .unopened()
            .or(unless(is_rate, "An animation has 1 to 1000 frames a second."))
    },
    action: Action::Do(|context, fps| set_fps(context.workspace, fps)),
};

/// The reason if no key is selected, or they can't change now.
fn no_keys(state: &State<'_>) -> Option<Reason> {
    let is_any = !state.workspace.keys.selected().is_empty();
    outside_work_pose(state).or(unless(is_any, "No key is selected: click one in the timeline."))
}

/// The reason if no file is open, or its handles are in a temporary pose.
pub(super) fn outside_work_pose(state: &State<'_>) -> Option<Reason> {
    state.unopened().or_else(|| state.in_work_pose())
}
