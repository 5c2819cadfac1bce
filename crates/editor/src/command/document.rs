//! Commands on the document as a whole.

use super::entry::{Action, Entry, Scope, ctrl, item, unless, when_open};
use super::shortcut::Shortcut;
use crate::document::HandleFootprints;
use crate::input::{Key, Modifiers};
use crate::jobs::JobKind;
use crate::warning::in_window_words;
use crate::workspace::{apply_shape, clear_regions, reset_shape, set_loose, set_loose_part, set_method, set_strength};
use pliant_deform::{Loose, Method};

/// Undoes the last step.
pub(super) const UNDO: Entry<()> = Entry {
    listed: &[item((), "Undo", "Undoes the last step.", "back revert", &[ctrl('z')])],
    scope: Scope::History,
    unavailable: |state, ()| {
        let undo = state.workspace.history.undo_name();
        let is_still = state.workspace.flow.is_still();
        let has_picks = !state.settings.pair_numbers(state.workspace).is_empty();
        unless(undo.is_some() || !is_still || has_picks, "There is nothing to undo.")
    },
    action: Action::Do(|context, ()| {
        if !context.settings.take_back_pick() {
            context.workspace.undo();
        }
    }),
};

/// Redoes the last undone step.
pub(super) const REDO: Entry<()> = Entry {
    listed: &[item(
        (),
        "Redo",
        "Redoes the step that was undone.",
        "again forth",
        &[Shortcut::with(Modifiers::CTRL_SHIFT, Key::Character('z')), ctrl('y')],
    )],
    scope: Scope::History,
    unavailable: |state, ()| {
        let redo = state.workspace.history.redo_name();
        unless(redo.is_some(), "There is nothing to redo.")
    },
    action: Action::Do(|context, ()| context.workspace.redo()),
};

/// Goes back or forth to the state after this many steps of the history.
pub(super) const GO_TO_STEP: Entry<usize> = Entry {
    listed: &[],
    scope: Scope::History,
    unavailable: |state, steps| {
        let is_there = *steps <= state.workspace.history.names().0.len();
        unless(is_there, "The history no longer has this step.")
    },
    action: Action::Do(|context, steps| context.workspace.go_to_step(steps)),
};

/// Makes the present shape the new rest shape: every handle's transform returns to the identity.
pub(super) const APPLY: Entry<()> = Entry {
    listed: &[item(
        (),
        "Apply shape",
        "Makes the present shape the new rest shape.",
        "bake freeze rest shape",
        &[Shortcut::with(Modifiers::CTRL, Key::Enter)],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        let is_bent = state.workspace.document.is_displaced();
        unless(is_bent, "Nothing is bent yet: move a handle first.")
            .or_else(|| state.in_work_pose())
            .or_else(|| state.in_sequence())
    },
    action: Action::Do(|context, ()| apply_shape(context.workspace)),
};

/// Takes the rest shape and every handle back to the file's shape.
pub(super) const RESET_SHAPE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Reset shape",
        "Resets the surface to the file's shape.",
        "original revert",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        let document = &state.workspace.document;
        let is_other = document.is_displaced() || document.is_applied();
        unless(is_other, "The shape is already the file's shape.")
            .or_else(|| state.in_work_pose())
            .or_else(|| state.in_sequence())
    },
    action: Action::Do(|context, ()| reset_shape(context.workspace)),
};

/// Shows a share (0 to 1) of the whole edit: everything that was moved, at that share of its displacement from rest.
pub(super) const SET_STRENGTH: Entry<f64> = Entry {
    listed: &[
        item(
            1.0,
            "Full strength",
            "Shows the whole edit.",
            "amount intensity blend 100%",
            &[],
        ),
        item(
            0.5,
            "Half strength",
            "Shows half of the edit: every handle moves half its way and turns by half its angle.",
            "amount intensity blend 50%",
            &[],
        ),
        item(
            0.0,
            "No strength",
            "Shows the shape without the edit. The strength in the panel brings the edit back.",
            "amount intensity blend off 0%",
            &[],
        ),
    ],
    scope: Scope::Document,
    unavailable: |state, _| {
        let document = &state.workspace.document;
        let is_moved = document.is_moved() || document.strength() < 1.0;
        let nothing = "Nothing is bent yet: move a handle first.";
        state
            .unopened()
            .or(unless(is_moved, nothing))
            .or_else(|| state.in_work_pose())
    },
    action: Action::Do(|context, share| set_strength(context.workspace, share)),
};

/// Fixes everything again: no handle, no region.
pub(super) const CLEAR_REGIONS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Clear regions",
        "Removes all handles and regions. The shape stays bent; Reset shape restores the file's shape.",
        "remove delete all handles",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        unless(state.workspace.is_painted(), "Nothing is painted.").or_else(|| state.in_work_pose())
    },
    action: Action::Do(|context, ()| clear_regions(context.workspace)),
};

/// Chooses the method and its options.
pub(super) const SET_METHOD: Entry<Method> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, method| {
        let has_footprints = !state.workspace.document.animation().footprints().is_empty();
        let refusal = HandleFootprints::refusal_by(method).filter(|_| has_footprints);
        when_open(state, method).or_else(|| Some(in_window_words(&format!("{}.", refusal?)).into()))
    },
    action: Action::Do(|context, method| set_method(context.workspace, method)),
};

/// Chooses the behaviour of all components that nothing holds.
pub(super) const SET_LOOSE: Entry<Loose> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, loose| set_loose(context.workspace, loose)),
};

/// Chooses the behaviour of one of them, by its component's number; `None` is the behaviour of all.
pub(super) const SET_LOOSE_PART: Entry<(u32, Option<Loose>)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, (part, loose)| set_loose_part(context.workspace, part, loose)),
};

/// Begins or ends a comparison of the methods on the edit.
pub(super) const COMPARE_METHODS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Compare methods",
        "Shows a small view of the edit by every method. Click one to use it.",
        "alternatives grid side by side arap poisson laplacian",
        &[],
    )],
    scope: Scope::View,
    unavailable: |state, ()| {
        let has_handles = !state.workspace.document.handles().is_empty();
        let is_comparing = state.workspace.jobs.comparison.is_some();
        let nothing_bends = "Nothing bends yet: paint a handle first.";
        state.unopened().or(unless(has_handles || is_comparing, nothing_bends))
    },
    action: Action::Do(|context, ()| {
        let workspace = &mut *context.workspace;
        match workspace.jobs.comparison {
            Some(_) => workspace.jobs.end_comparing(),
            None => workspace.jobs.begin_comparing(&workspace.document),
        }
    }),
};

/// Shows one method's result large beside the view, or the results of all methods below it.
pub(super) const ENLARGE_METHOD: Entry<Option<usize>> = Entry {
    listed: &[],
    scope: Scope::View,
    unavailable: |state, _| {
        let is_comparing = state.workspace.jobs.comparison.is_some();
        unless(is_comparing, "No methods are compared: choose Compare methods first.")
    },
    action: Action::Do(|context, number| {
        if let Some(comparison) = &mut context.workspace.jobs.comparison {
            comparison.enlarge(number);
        }
    }),
};

/// Stops the running jobs; anything that needs them starts them again.
pub(super) const CANCEL_JOBS: Entry<()> = Entry {
    listed: &[item((), "Stop", "Stops the computation.", "cancel abort", &[])],
    scope: Scope::View,
    unavailable: |state, ()| {
        let mut running = state.workspace.jobs.running().into_iter();
        unless(running.any(|(kind, _)| kind != JobKind::Pick), "Nothing is running.")
    },
    action: Action::Do(|context, ()| {
        let workspace = &mut *context.workspace;
        workspace.jobs.give_up(&workspace.document);
        workspace.stop_flow();
    }),
};
