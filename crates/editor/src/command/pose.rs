//! Commands on kept poses.

use super::entry::{Action, Entry, Reason, Scope, State, item, unless};
use crate::workspace::{keep_pose, remove_pose, rename_pose, renew_pose, take_pose, toggle_work_pose};

/// Keeps the shown state as a pose.
pub(super) const KEEP_POSE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Keep pose",
        "Keeps the positions of handles and control points under a name.",
        "save store library snapshot bookmark",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        let document = &state.workspace.document;
        let is_posed = !document.handles().is_empty() || document.bends_without_handles();
        let nothing = "There is no handle or control point to keep: paint a handle first.";
        state.unopened().or(unless(is_posed, nothing))
    },
    action: Action::Do(|context, ()| keep_pose(context.workspace)),
};

/// Moves everything to a pose, by its place in the list.
pub(super) const TAKE_POSE: Entry<usize> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, place| gone(state, *place),
    action: Action::Do(|context, place| take_pose(context.workspace, place)),
};

/// Replaces a pose by the shown state.
pub(super) const RENEW_POSE: Entry<usize> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, place| gone(state, *place),
    action: Action::Do(|context, place| renew_pose(context.workspace, place)),
};

/// Renames a pose.
pub(super) const RENAME_POSE: Entry<(usize, String)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (place, _)| gone(state, *place),
    action: Action::Do(|context, (place, name)| rename_pose(context.workspace, place, name)),
};

/// Removes a pose.
pub(super) const REMOVE_POSE: Entry<usize> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, place| gone(state, *place),
    action: Action::Do(|context, place| remove_pose(context.workspace, place)),
};

/// Begins a temporary pose, or returns from it.
pub(super) const WORK_POSE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Work pose",
        "Begins a temporary pose: move limbs apart, paint and correct hidden places. The second time everything returns \
         exactly, with your paint and corrections.",
        "temporary spread legs arms reach hidden clothes unpose return",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        let document = &state.workspace.document;
        let may_begin = document.is_settled() || document.work_pose().is_some();
        let busy = "The shape is still being solved: wait a moment.";
        let refused = state.unopened().or_else(|| state.in_sequence());
        refused.or(unless(may_begin, busy))
    },
    action: Action::Do(|context, ()| toggle_work_pose(context.workspace)),
};

fn gone(state: &State<'_>, place: usize) -> Option<Reason> {
    let poses = state.workspace.document.poses();
    unless(place < poses.len(), "This pose no longer exists.")
}
