//! Commands that show parts of the file and allow painting on them.

use super::entry::{Action, Entry, Scope, alt, character, item, shift, unless, when_open};
use crate::document::{ObjectAction, SmallParts};
use crate::workspace::{
    act_on_object_here, act_on_objects, isolate, set_small_parts, show_everything, turn_inside_out,
};

/// The same with the object under the pointer.
pub(super) const OBJECT_HERE: Entry<ObjectAction> = Entry {
    listed: &[
        item(
            ObjectAction::Hide,
            "Hide object",
            "Hides the object under the pointer. It can't be picked or painted, but still follows the surface.",
            "invisible",
            &[character('h')],
        ),
        item(
            ObjectAction::Solo,
            "Isolate object",
            "Hides all objects but the one under the pointer, or shows everything again.",
            "solo",
            &[shift('h')],
        ),
        item(
            ObjectAction::Lock,
            "Lock object",
            "Locks the object under the pointer, so that it stays fixed, whatever is painted on it.",
            "freeze protect",
            &[],
        ),
    ],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, action| {
        let pointed_at = context.pointed_at();
        act_on_object_here(context.workspace, action, pointed_at);
    }),
};

/// Hides, shows or locks objects, by their numbers in [`pliant_mesh::Model::all_objects`].
pub(super) const OBJECTS: Entry<(ObjectAction, Vec<u32>)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, (action, objects)| act_on_objects(context.workspace, action, &objects)),
};

/// Sets the size below which connected parts are small, and whether they are shown and fixed.
pub(super) const SET_SMALL_PARTS: Entry<SmallParts> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, small| set_small_parts(context.workspace, small)),
};

/// Hides or shows small parts.
pub(super) const TOGGLE_SMALL_SHOWN: Entry<()> = Entry {
    listed: &[item(
        (),
        "Hide small parts",
        "Hides connected parts with few vertices, or shows them again. Objects in the panel sets the limit.",
        "debris floaters isolated pieces islands components clean noise delete",
        &[],
    )],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, ()| {
        let small = context.workspace.document.access().small;
        let hidden = !small.hidden;
        set_small_parts(context.workspace, SmallParts { hidden, ..small });
    }),
};

/// Fixes small parts, or lets them bend.
pub(super) const TOGGLE_SMALL_LOCKED: Entry<()> = Entry {
    listed: &[item(
        (),
        "Lock small parts",
        "Locks connected parts with few vertices, so that they stay fixed, or unlocks them.",
        "debris floaters isolated pieces islands components freeze",
        &[],
    )],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, ()| {
        let small = context.workspace.document.access().small;
        let locked = !small.locked;
        set_small_parts(context.workspace, SmallParts { locked, ..small });
    }),
};

/// Hides all connected parts except the one under the pointer, or shows the others again.
pub(super) const ISOLATE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Isolate part",
        "Hides all connected parts but the one under the pointer, or shows them again.",
        "solo local view component",
        &[character('/')],
    )],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, ()| {
        let pointed_at = context.pointed_at();
        isolate(context.workspace, pointed_at);
    }),
};

/// Turns connected parts inside out, or back again.
pub(super) const TURN_INSIDE_OUT: Entry<()> = Entry {
    listed: &[item(
        (),
        "Turn inside out",
        "Turns the parts that face inwards inside out, or all visible parts if none does. Their triangles and normals are saved reversed; the bend stays.",
        "flip normals faces winding reverse recalculate outside",
        &[],
    )],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, ()| turn_inside_out(context.workspace)),
};

/// Shows everything hidden.
pub(super) const SHOW_EVERYTHING: Entry<()> = Entry {
    listed: &[item(
        (),
        "Show everything",
        "Shows all objects and parts that are hidden.",
        "unhide reveal",
        &[alt('h')],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        let is_any = !state.workspace.document.access().shows_all();
        unless(is_any, "Nothing is hidden.")
    },
    action: Action::Do(|context, ()| show_everything(context.workspace)),
};
