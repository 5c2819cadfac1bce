//! Actions on objects: hide, isolate, lock, by the list or under the pointer.

use std::collections::BTreeSet;
use std::sync::Arc;

use pliant_mesh::Model;

use super::state::Workspace;
use crate::document::{Access, ObjectAction, SmallParts, object_name};
use crate::view::Pick;

/// Executes an action on objects, by their numbers in [`pliant_mesh::Model::all_objects`].
pub(crate) fn act_on_objects(workspace: &mut Workspace, action: ObjectAction, objects: &[u32]) {
    let Some(model) = workspace.model().cloned() else {
        return;
    };
    let all = model.all_objects();
    if objects.iter().any(|&object| object as usize >= all.len()) {
        workspace.refuse("The file has no such object: choose one from the list.");
        return;
    }
    let access = workspace.document.access.after(action, objects, all.len() as u32);
    let what = match objects {
        [one] => object_name(&all[*one as usize].name, *one),
        several => format!("{} objects", several.len()),
    };
    let name = match action {
        ObjectAction::Solo if access.shows_all() => "Show everything".to_owned(),
        _ => format!("{} {what}", action.name()),
    };
    set_access(workspace, name, access);
}

/// Shows everything.
pub(crate) fn show_everything(workspace: &mut Workspace) {
    let present = workspace.document.access();
    let access = Access {
        hidden: BTreeSet::new(),
        isolated: None,
        small: SmallParts {
            hidden: false,
            ..present.small
        },
        locked: present.locked.clone(),
    };
    set_access(workspace, "Show everything".to_owned(), access);
}

/// Sets the size below which parts are small, and whether they are shown and fixed.
pub(crate) fn set_small_parts(workspace: &mut Workspace, small: SmallParts) {
    let access = workspace.document.access().clone();
    let name = match (small.hidden, small.locked) {
        (true, _) if !access.small.hidden => "Hide small parts",
        (false, _) if access.small.hidden => "Show small parts",
        (_, true) if !access.small.locked => "Lock small parts",
        (_, false) if access.small.locked => "Unlock small parts",
        _ => "Size of small parts",
    };
    set_access(workspace, name.to_owned(), Access { small, ..access });
}

/// Shows only the connected part under the pointer, or everything else again.
pub(crate) fn isolate(workspace: &mut Workspace, pointed_at: Option<Pick>) {
    let access = workspace.document.access().clone();
    if access.isolated.is_some() {
        let isolated = None;
        return set_access(
            workspace,
            "Show the other parts".to_owned(),
            Access { isolated, ..access },
        );
    }
    let (Some(pick), Some(model)) = (pointed_at, workspace.model()) else {
        return workspace.refuse(NOTHING_HERE);
    };
    let isolated = Some(model.topology.component(pick.vertex));
    set_access(workspace, "Isolate part".to_owned(), Access { isolated, ..access });
}

/// Swaps outside and inside of the isolated part; else of those that face inwards; else of all shown ones. A second
/// time swaps them back.
pub(crate) fn turn_inside_out(workspace: &mut Workspace) {
    let Some(model) = workspace.model().cloned() else {
        return;
    };
    let parts = match workspace.document.access().isolated {
        Some(part) => BTreeSet::from([part]),
        None if !model.inside_out.is_empty() => model.inside_out.iter().copied().collect(),
        None => shown_parts(&model, workspace.document.access()),
    };
    let name = match parts.len() {
        0 => return workspace.refuse("No visible object has triangles: show one first."),
        1 => "Turn 1 part inside out".to_owned(),
        several => format!("Turn {several} parts inside out"),
    };
    workspace.change(name, |document| {
        let turned = document.inside_out().symmetric_difference(&parts).copied().collect();
        document.set_inside_out(Arc::new(turned));
    });
}

/// The connected parts with a shown triangle.
fn shown_parts(model: &Model, access: &Access) -> BTreeSet<u32> {
    let shown = access.shown_triangles(model);
    let shown = shown.unwrap_or_else(|| vec![true; model.drawn.triangle_count()]);
    let surface = model.surface.triangles.iter().zip(model.drawn.triangle_of_surface());
    let shown = surface.filter(|(_, drawn)| shown.get(**drawn as usize).is_some_and(|is_shown| *is_shown));
    shown.map(|([first, ..], _)| model.topology.component(*first)).collect()
}

/// Executes an action on the object under the pointer.
pub(crate) fn act_on_object_here(workspace: &mut Workspace, action: ObjectAction, pointed_at: Option<Pick>) {
    let object = pointed_at.and_then(|pick| workspace.model()?.object_of(pick.triangle));
    match object {
        Some(object) => act_on_objects(workspace, action, &[object as u32]),
        None => workspace.refuse(NOTHING_HERE),
    }
}

fn set_access(workspace: &mut Workspace, name: String, access: Access) {
    if *workspace.document.access() == access {
        return;
    }
    // The fixed part belongs to the problem, and no change of it moves a vertex.
    let relocked = access.locks() != workspace.document.access.locks();
    if relocked {
        workspace.jobs.drop_solves();
    }
    workspace.change(name, |document| {
        if relocked {
            document.keep_shape();
        }
        document.set_access(Arc::new(access));
    });
}

/// The refusal of commands for the place under the pointer.
pub(crate) const NOTHING_HERE: &str =
    "There is nothing under the pointer: point at a part of the surface, and give the command there.";
