//! Commands that move handles: the gizmo, the gestures and typed values.

use glam::{DVec2, DVec3};

use super::entry::{
    Action, Entry, Reason, Scope, State, alt, always, character, item, shift, with_selected, with_unlocked,
};
use crate::document::{HandleId, HandleTransform, PivotPlace};
use crate::format::without_pivot;
use crate::tool::{Constraint, Context, Gesture, TransformDrag, TransformKind};
use crate::view::{GizmoMode, GizmoOrientation};
use crate::workspace::{set_pivot, set_pivot_place, set_turn, transform_handle};

/// The gizmo's mode.
pub(super) const SET_GIZMO: Entry<GizmoMode> = Entry {
    listed: &[],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, mode| context.settings.gizmo_mode = mode),
};

/// The axes of the gizmo.
pub(super) const SET_ORIENTATION: Entry<GizmoOrientation> = Entry {
    listed: &[
        item(
            GizmoOrientation::World,
            "World axes",
            "Aligns the gizmo with the world's axes.",
            "global orientation",
            &[],
        ),
        item(
            GizmoOrientation::Local,
            "Own axes",
            "Aligns the gizmo with the handle's own axes.",
            "local orientation",
            &[],
        ),
        item(
            GizmoOrientation::View,
            "Screen axes",
            "Aligns the gizmo with the screen.",
            "view orientation",
            &[],
        ),
    ],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, orientation| context.settings.orientation = orientation),
};

/// The next click on the surface moves the selected handle's pivot there.
pub(super) const PICK_PIVOT: Entry<()> = Entry {
    listed: &[item(
        (),
        "Pick pivot",
        "Sets the pivot, about which the handle turns, with the next click on the surface.",
        "origin centre center",
        &[shift('p')],
    )],
    scope: Scope::Document,
    unavailable: with_unlocked,
    action: Action::Do(|context, ()| {
        context.settings.want_nothing();
        context.settings.wants_pivot = true;
    }),
};

/// Moves a handle's pivot to a point of the present shape. The surface does not change.
pub(super) const SET_PIVOT: Entry<(HandleId, DVec3)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (id, _)| state.gone(*id),
    action: Action::Do(|context, (id, point)| set_pivot(context.workspace, id, point)),
};

/// Chooses the place of a handle's pivot. The surface does not change.
pub(super) const SET_PIVOT_PLACE: Entry<(HandleId, PivotPlace)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (id, _)| state.gone(*id),
    action: Action::Do(|context, (id, place)| set_pivot_place(context.workspace, id, place)),
};

/// Starts moving the selected handle with the pointer.
pub(super) const MOVE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Move",
        "Moves the selected handle, or the selected points of a cage or lattice, with the pointer.",
        "translate grab drag",
        &[character('g')],
    )],
    scope: Scope::Gesture,
    unavailable: with_something,
    action: Action::Begin(|context, ()| transform(context, TransformKind::Move)),
};

/// Starts turning the selected handle with the pointer.
pub(super) const TURN: Entry<()> = Entry {
    listed: &[item(
        (),
        "Turn",
        "Turns the selected handle, or the selected points of a cage or lattice, with the pointer.",
        "rotate spin",
        &[character('r')],
    )],
    scope: Scope::Gesture,
    unavailable: with_something,
    action: Action::Begin(|context, ()| transform(context, TransformKind::Turn)),
};

/// Starts scaling the selected handle with the pointer.
pub(super) const SCALE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Scale",
        "Scales the selected handle, or the selected points of a cage or lattice, with the pointer.",
        "size grow shrink",
        &[character('s')],
    )],
    scope: Scope::Gesture,
    unavailable: with_something,
    action: Action::Begin(|context, ()| transform(context, TransformKind::Scale)),
};

/// Takes the selected handle back to its rest position.
pub(super) const RESET_HANDLE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Reset handle",
        "Moves the selected handle back to its rest position.",
        "clear transform",
        &[alt('g')],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| match state.selected() {
        Err(reason) => Some(reason),
        Ok(handle) if handle.transform.is_identity() => {
            Some(format!("{} is already at its rest position.", handle.name).into())
        }
        Ok(_) => None,
    },
    action: Action::Do(|context, ()| {
        if let Some(id) = context.workspace.selection.selected() {
            transform_handle(context.workspace, "Reset", id, HandleTransform::IDENTITY);
        }
    }),
};

/// Sets a handle's transform, about its own pivot.
pub(super) const SET_HANDLE_TRANSFORM: Entry<(HandleId, HandleTransform)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (id, _)| state.gone(*id),
    action: Action::Do(|context, (id, transform)| {
        if transform.affine(DVec3::ZERO).is_finite() {
            transform_handle(context.workspace, "Move", id, without_pivot(transform));
        } else {
            let why = "The handle's transform is not finite: enter other numbers.";
            context.workspace.refuse(why);
        }
    }),
};

/// Turns a handle to these angles about x, y and z in degrees, full turns included.
pub(super) const SET_TURN: Entry<(HandleId, DVec3)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (id, _)| state.gone(*id),
    action: Action::Do(|context, (id, turn_deg)| set_turn(context.workspace, id, turn_deg)),
};

/// For commands that need selected control points or a selected handle.
fn with_something(state: &State<'_>, values: &()) -> Option<Reason> {
    if state.workspace.controls.is_empty() {
        with_selected(state, values)
    } else {
        None
    }
}

/// Begins to move, turn or scale the selected control points or the selected handle with the pointer.
fn transform(context: &mut Context<'_>, kind: TransformKind) -> Option<Box<dyn Gesture>> {
    let middle_px: DVec2 = context.view.viewport_px() * 0.5;
    let start_px = context.pointer.map_or(middle_px, |pointer| pointer.position_px);
    let drag = TransformDrag::begin(context, kind, Constraint::Free, start_px)?;
    Some(Box::new(drag))
}
