//! Commands that make and choose handles, and set the way in which they hold.

use super::entry::{
    Action, Entry, Scope, alt, character, item, plain, shift, when_open, with_handles, with_selected, with_unlocked,
};
use crate::document::{HandleId, Reach};
use crate::input::Key;
use crate::tool::{ToolMode, Widen};
use crate::workspace::{
    Purpose, change_handle, delete_selected, free_or_hold_selected, mirror, pin_or_unpin_selected, reset_region,
    set_continuity, set_parent, set_reach, set_soft, split_selected, untwin,
};

/// Widens the selected handle's reach with the pointer.
pub(super) const WIDEN: Entry<()> = Entry {
    listed: &[item(
        (),
        "Set reach",
        "Sets with the pointer how far the surface follows the selected handle.",
        "region of influence roi falloff radius distance",
        &[character('e')],
    )],
    scope: Scope::Gesture,
    unavailable: with_unlocked,
    action: Action::Begin(|context, ()| {
        let widen = Widen::begin(context.workspace, context.view, context.pointer)?;
        Some(Box::new(widen))
    }),
};

/// Splits the selected handle in two across its longest side; a vertex can only be in one handle.
pub(super) const DUPLICATE_HANDLE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Duplicate handle",
        "Splits the selected handle in two along its longest side.",
        "copy split",
        &[shift('d')],
    )],
    scope: Scope::Document,
    unavailable: with_unlocked,
    action: Action::Do(|context, ()| split_selected(context.workspace)),
};

/// Makes the selected handle's mirror image a handle with the mirrored motion, across axis 0, 1, 2 for x, y, z.
pub(super) const MAKE_TWIN: Entry<usize> = Entry {
    listed: &[
        item(
            0,
            "Twin across x",
            "Makes a mirrored handle on the other side: drag the left one, and the right one follows.",
            "mirror symmetry",
            &[shift('m')],
        ),
        item(
            1,
            "Twin across y",
            "Makes a mirrored handle above or below, which follows.",
            "mirror symmetry",
            &[],
        ),
        item(
            2,
            "Twin across z",
            "Makes a mirrored handle in front or behind, which follows.",
            "mirror symmetry",
            &[],
        ),
    ],
    scope: Scope::Document,
    unavailable: |state, _| match state.unlocked() {
        Err(reason) => Some(reason),
        Ok(handle) if handle.twin.is_some() => {
            Some(format!("{} already has a twin: part them first.", handle.name).into())
        }
        Ok(_) => None,
    },
    action: Action::Do(|context, axis| {
        if let Some(id) = context.workspace.selection.selected() {
            mirror(context.workspace, Purpose::Twin(id), axis);
        }
    }),
};

/// Lets the selected handle and its mirrored twin move separately again.
pub(super) const UNTWIN: Entry<()> = Entry {
    listed: &[item(
        (),
        "Part twins",
        "Lets the selected handle and its mirrored twin move separately again.",
        "unlink mirror symmetry",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| match state.selected() {
        Err(reason) => Some(reason),
        Ok(handle) if handle.twin.is_none() => Some(format!("{} has no twin.", handle.name).into()),
        Ok(_) => None,
    },
    action: Action::Do(|context, ()| untwin(context.workspace)),
};

/// Takes the selected handle's vertices and its region back to the file's shape.
pub(super) const RESET_REGION: Entry<()> = Entry {
    listed: &[item(
        (),
        "Reset region",
        "Resets only the selected handle and its region to the file's shape.",
        "original revert",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| state.unlocked().err().or_else(|| state.in_work_pose()),
    action: Action::Do(|context, ()| reset_region(context.workspace)),
};

/// The next stroke of the handle brush makes a new handle.
pub(super) const NEW_HANDLE: Entry<()> = Entry {
    listed: &[item(
        (),
        "New handle",
        "The next stroke of the handle brush makes a new handle.",
        "add create",
        &[shift('n')],
    )],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, ()| {
        context.settings.mode = ToolMode::PaintHandle;
        context.workspace.selection.wants_new_handle = true;
        context.workspace.selection.put(None);
    }),
};

/// Selects a handle; its gizmo is shown.
pub(super) const SELECT_HANDLE: Entry<HandleId> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, id| state.gone(*id),
    action: Action::Do(|context, id| {
        context.workspace.controls.put([]);
        context.workspace.selection.put_alone(Some(id));
    }),
};

/// Adds a handle to the selected ones, or removes it from them.
pub(super) const TOGGLE_SELECTED: Entry<HandleId> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, id| state.gone(*id),
    action: Action::Do(|context, id| {
        context.workspace.controls.put([]);
        context.workspace.selection.toggle(id);
    }),
};

/// Selects all handles.
pub(super) const SELECT_ALL: Entry<()> = Entry {
    listed: &[item(
        (),
        "Select all handles",
        "Selects all handles, so that they move together.",
        "every everything",
        &[character('a')],
    )],
    scope: Scope::Document,
    unavailable: with_handles,
    action: Action::Do(|context, ()| {
        let workspace = &mut *context.workspace;
        workspace.controls.put([]);
        workspace.selection.put_all(&workspace.document);
    }),
};

/// Selects the next handle of the list.
pub(super) const NEXT_HANDLE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Next handle",
        "Selects the next handle.",
        "cycle",
        &[plain(Key::Tab)],
    )],
    scope: Scope::Document,
    unavailable: with_handles,
    action: Action::Do(|context, ()| {
        let workspace = &mut *context.workspace;
        workspace.controls.put([]);
        workspace.selection.put_next(&workspace.document);
    }),
};

/// Selects no handle.
pub(super) const DESELECT: Entry<()> = Entry {
    listed: &[item(
        (),
        "Deselect",
        "Deselects all handles.",
        "unselect none",
        &[alt('a')],
    )],
    scope: Scope::Document,
    unavailable: with_selected,
    action: Action::Do(|context, ()| context.workspace.selection.put_alone(None)),
};

/// Deletes the selected handle; its vertices become fixed.
pub(super) const DELETE_HANDLE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Delete handle",
        "Deletes the selected handle. The shape stays.",
        "remove",
        &[plain(Key::Delete), character('x')],
    )],
    scope: Scope::Document,
    unavailable: with_unlocked,
    action: Action::Do(|context, ()| delete_selected(context.workspace)),
};

/// Pins the selected handle, or unpins it.
pub(super) const PIN: Entry<()> = Entry {
    listed: &[item(
        (),
        "Pin or unpin",
        "Pins the selected handle, or unpins it.",
        "hold stay here keep fix unpin",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| state.selected().err(),
    action: Action::Do(|context, ()| pin_or_unpin_selected(context.workspace)),
};

/// Frees the selected handle along the direction of sight, or holds it there again.
pub(super) const FREE_OR_HOLD_DEPTH: Entry<()> = Entry {
    listed: &[item(
        (),
        "Free or hold depth",
        "Holds the selected handle, or the points of its curve that you drag, only where you see it: it stays under the \
         pointer, and the shape chooses its distance from you. Or holds it in depth again.",
        "plane of the picture screen view projection constraint slide free distance",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| match state.unlocked() {
        Err(reason) => Some(reason),
        Ok(handle) if handle.is_pin => Some(format!("{} is pinned: unpin it first.", handle.name).into()),
        Ok(handle) if handle.line.as_ref().is_some_and(|line| line.sketch().is_some()) => {
            Some(format!("{} follows an outline, which is drawn in the picture.", handle.name).into())
        }
        Ok(_) => None,
    },
    action: Action::Do(|context, ()| free_or_hold_selected(context.workspace, context.view.camera())),
};

/// Names a handle.
pub(super) const RENAME_HANDLE: Entry<(HandleId, String)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (id, _)| state.gone(*id),
    action: Action::Do(|context, (id, name)| {
        change_handle(context.workspace, "Rename handle", id, |handle| handle.name = name)
    }),
};

/// Gives a handle a colour, sRGB with alpha.
pub(super) const SET_HANDLE_COLOUR: Entry<(HandleId, [u8; 4])> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (id, _)| state.gone(*id),
    action: Action::Do(|context, (id, colour)| {
        change_handle(context.workspace, "Change colour", id, |handle| handle.colour = colour)
    }),
};

/// Shows or hides a handle's colour and gizmo.
pub(super) const TOGGLE_HANDLE_VISIBLE: Entry<HandleId> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, id| state.gone(*id),
    action: Action::Do(|context, id| {
        change_handle(context.workspace, "Show or hide handle", id, |handle| {
            handle.visible = !handle.visible
        })
    }),
};

/// Locks a handle against being moved, painted and deleted, or unlocks it.
pub(super) const TOGGLE_HANDLE_LOCKED: Entry<HandleId> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, id| state.gone(*id),
    action: Action::Do(|context, id| {
        change_handle(context.workspace, "Lock or unlock handle", id, |handle| {
            handle.locked = !handle.locked
        })
    }),
};

/// The distance along the surface within which a handle moves the surface.
pub(super) const SET_REACH: Entry<(HandleId, Reach)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (id, _)| state.gone(*id),
    action: Action::Do(|context, (id, reach)| set_reach(context.workspace, id, reach)),
};

/// Gives a handle a weight ([`SOFT_RANGE`](crate::SOFT_RANGE)), so that it only pulls; `None` makes it hard.
pub(super) const SET_SOFT: Entry<(HandleId, Option<f64>)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (id, _)| state.gone(*id),
    action: Action::Do(|context, (id, soft)| set_soft(context.workspace, id, soft)),
};

/// Chooses the handle with which a handle rides along.
pub(super) const SET_PARENT: Entry<(HandleId, Option<HandleId>)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (id, parent)| state.gone(*id).or_else(|| parent.and_then(|parent| state.gone(parent))),
    action: Action::Do(|context, (id, parent)| set_parent(context.workspace, id, parent)),
};

/// The continuity ([`pliant_deform::CONTINUITY_RANGE`]) with which the surface joins a handle; `None` is the smoothest.
pub(super) const SET_CONTINUITY: Entry<(HandleId, Option<f64>)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (id, _)| state.gone(*id),
    action: Action::Do(|context, (id, continuity)| set_continuity(context.workspace, id, continuity)),
};
