//! Commands on the method's cage or lattice and its control points.

use pliant_deform::{Attachment, AttachmentKind};

use super::entry::{Action, Entry, Reason, Scope, State, item, unless, when_open};
use crate::tool::ToolMode;
use crate::workspace::{bring_attachment, make_controls, reset_controls};

/// Makes the method's own cage or lattice replace the document's.
pub(super) const MAKE_CONTROLS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Make cage or lattice",
        "Replaces your own cage or lattice with a new one around the region.",
        "control points generate new detail resolution",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        without_controls(state).or_else(|| {
            let is_own = state.workspace.document.attachment().is_some();
            unless(
                is_own,
                "The method already makes it: drag one of its points to make it your own.",
            )
        })
    },
    action: Action::Do(|context, ()| make_controls(context.workspace)),
};

/// Takes the control points back to their rest positions.
pub(super) const RESET_CONTROLS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Reset points",
        "Moves the points of the cage or lattice back to their rest positions. Handles stay.",
        "control cage lattice undo moves",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        without_controls(state).or_else(|| {
            let are_moved = state.workspace.document.moved_controls().is_some();
            unless(are_moved, "No point of the cage or lattice was moved by hand.")
        })
    },
    action: Action::Do(|context, ()| reset_controls(context.workspace)),
};

/// Selects all control points.
pub(super) const SELECT_CONTROLS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Select all points",
        "Selects all points of the curve, cage or lattice.",
        "control cage lattice everything",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| match state.workspace.shown_controls() {
        Some(_) => None,
        None => without_controls(state).or_else(|| not_shown(state)),
    },
    action: Action::Do(|context, ()| {
        let shown = context.workspace.shown_controls();
        let Some(shown) = shown else { return };
        if !context.settings.shows(&shown.source) {
            context.settings.mode = ToolMode::Select;
        }
        context.workspace.controls.put(0..shown.positions.len() as u32);
    }),
};

/// Deselects all control points.
pub(super) const DESELECT_CONTROLS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Deselect points",
        "Deselects the points of the curve, cage or lattice, so that the gizmo moves the handle again.",
        "control cage lattice none",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        let is_selected = !state.workspace.controls.is_empty();
        unless(is_selected, "No point of a curve, cage or lattice is selected.")
    },
    action: Action::Do(|context, ()| context.workspace.controls.put([])),
};

/// Replaces the present cage or lattice.
pub(super) const BRING_ATTACHMENT: Entry<Attachment> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, attachment| bring_attachment(context.workspace, attachment)),
};

/// The reason if the method has no control points.
fn without_controls(state: &State<'_>) -> Option<Reason> {
    state.unopened().or_else(|| {
        let mut attachments = state.workspace.document.method().declaration().attachments.iter();
        unless(
            attachments.any(|own| own.kind != AttachmentKind::Shapes),
            "The method has no control points: choose Cage or Lattice.",
        )
    })
}

fn not_shown(state: &State<'_>) -> Option<Reason> {
    let is_shown = state.workspace.shown_controls().is_some();
    unless(is_shown, "The points appear once the method is bound: wait a moment.")
}
