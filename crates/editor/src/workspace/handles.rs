//! Actions on handles: transforms, pivots, splits, twins, deletion, and a reset with their region.

use glam::DVec3;
use pliant_deform::Role;
use pliant_mesh::{Model, SurfaceVertex};

use super::painting::{border_middle, members, repaint, tidy_handles};
use super::state::Workspace;
use crate::document::{
    Document, Handle, HandleId, HandleTransform, Paint, PivotPlace, Reach, VertexAccess, find_parents_anew, means,
    mirrored_transform,
};

/// The reason why a handle can't be moved, if it can't.
pub(crate) fn held_because(workspace: &Workspace, id: HandleId) -> Option<String> {
    let handle = workspace.document.handle(id)?;
    if handle.locked {
        return Some(format!("{} is locked: unlock it in the list to move it.", handle.name));
    }
    if handle.is_pin {
        return Some(format!(
            "{} is pinned: choose *Unpin* to move it as a handle.",
            handle.name
        ));
    }
    let access = &workspace.vertex_access;
    let is_locked = |vertex: SurfaceVertex| access.is_locked(vertex.index());
    let is_held = access.locks_any() && members(&workspace.document, id).into_iter().all(is_locked);
    is_held.then(|| {
        format!(
            "{} is on a locked object: unlock the object in the list of objects to move it.",
            handle.name
        )
    })
}

/// Sets a handle's transform in the present document: the surface follows as soon as it can, and so do its descendants,
/// its twin and the twin's descendants.
pub(crate) fn put_handle(workspace: &mut Workspace, id: HandleId, transform: HandleTransform) {
    put_handles(workspace, &[(id, transform)]);
}

/// Sets the transforms of handles that move together; those among them that are descendants of others do not move twice.
pub(crate) fn put_handles(workspace: &mut Workspace, given: &[(HandleId, HandleTransform)]) {
    let mut moved = Vec::new();
    for &(id, transform) in given {
        if let Some(why) = held_because(workspace, id) {
            workspace.refuse(why);
            continue;
        }
        let handle = workspace.document.handle(id);
        if handle.is_none_or(|handle| handle.transform == transform) {
            continue;
        }
        if !transform.can_be_undone() {
            workspace.refuse("That would flatten the handle for good: give a scale other than 0.".to_owned());
            continue;
        }
        // A number passes through 0 while it is typed digit by digit.
        workspace.refusal = None;
        moved.push((id, transform));
    }
    if moved.is_empty() {
        return;
    }
    let given: Vec<HandleId> = given.iter().map(|(id, _)| *id).collect();
    add_descendants(workspace, &given, &mut moved, 0);
    let first_twin = moved.len();
    add_twins(workspace, &given, &mut moved);
    add_descendants(workspace, &given, &mut moved, first_twin);
    workspace.document.unsettle();
    for (id, transform) in moved {
        put_alone(workspace, id, transform);
    }
}

/// Adds the children that ride along with the moved handles from number `first` on, and theirs.
fn add_descendants(
    workspace: &Workspace,
    given: &[HandleId],
    moved: &mut Vec<(HandleId, HandleTransform)>,
    first: usize,
) {
    let handles = workspace.document.handles();
    let mut next = first;
    while let Some(&(id, transform)) = moved.get(next) {
        next += 1;
        let Some(parent) = workspace.document.handle(id) else {
            continue;
        };
        let motion = transform.affine(parent.pivot) * parent.affine().inverse();
        for child in handles.iter().filter(|child| child.parent == Some(id)) {
            let rides = !given.contains(&child.id)
                && moved.iter().all(|(other, _)| *other != child.id)
                && held_because(workspace, child.id).is_none();
            let carried = child.transform.carried(&motion, child.pivot);
            if rides && carried.can_be_undone() {
                moved.push((child.id, carried));
            }
        }
    }
}

/// Adds the twins of the moved handles, with mirrored transforms.
fn add_twins(workspace: &Workspace, given: &[HandleId], moved: &mut Vec<(HandleId, HandleTransform)>) {
    for number in 0..moved.len() {
        let (id, transform) = moved[number];
        let handle = workspace.document.handle(id);
        let Some((twin, pivot)) = handle.and_then(|handle| Some((handle.twin?, handle.pivot))) else {
            continue;
        };
        let is_free = !given.contains(&twin.handle) && moved.iter().all(|(other, _)| *other != twin.handle);
        if is_free && held_because(workspace, twin.handle).is_none() {
            moved.push((twin.handle, mirrored_transform(&twin.plane, transform, pivot)));
        }
    }
}

/// Sets a handle's transform; before the factorisation is ready its own vertices follow it, and the rest stays.
fn put_alone(workspace: &mut Workspace, id: HandleId, transform: HandleTransform) {
    let document = &mut workspace.document;
    document.change_handle(id, |handle| handle.put(transform));
    if !workspace.jobs.is_bound()
        && let Some(model) = workspace.jobs.computed.model.as_deref()
        && let Some(from_rest) = moved_alone(document, model, &workspace.vertex_access, id)
    {
        document.bend(from_rest);
    }
}

/// The shape with a handle's own vertices moved by it, as displacements from the rest shape.
fn moved_alone(document: &Document, model: &Model, access: &VertexAccess, id: HandleId) -> Option<Vec<DVec3>> {
    let affine = document.handle(id)?.affine();
    let kept = document
        .kept
        .as_ref()
        .and_then(|kept| Some((kept, kept.targets.get(&id)?)));
    let mut from_rest: Vec<DVec3> = document.from_rest().to_vec();
    for vertex in members(document, id).into_iter().map(SurfaceVertex::index) {
        if !access.is_locked(vertex) {
            let applied = if document.is_applied() {
                document.rest()[vertex]
            } else {
                DVec3::ZERO
            };
            let rest = model.surface.positions[vertex] + applied;
            from_rest[vertex] = match kept {
                Some((kept, first)) => {
                    kept.shape[vertex] + affine.transform_point3(rest) - first.transform_point3(rest)
                }
                None => affine.transform_point3(rest) - rest,
            };
        }
    }
    Some(from_rest)
}

/// Sets the counted turn of a handle, if that is its rotation.
pub(crate) fn count_turn(workspace: &mut Workspace, id: HandleId, turn_deg: DVec3) {
    workspace.document.change_handle(id, |handle| {
        if let HandleTransform::Trs { rotation, .. } = handle.transform
            && means(turn_deg, rotation)
        {
            handle.turn_deg = turn_deg;
        }
    });
}

/// Changes a handle in one step.
pub(crate) fn change_handle(
    workspace: &mut Workspace,
    name: impl Into<String>,
    id: HandleId,
    change: impl FnOnce(&mut Handle),
) {
    workspace.change(name, |document| {
        document.change_handle(id, change);
    });
}

/// Deletes the selected handle. The vertices that it has moved keep their positions, held by a pin; after the deletion
/// of a pin the next drag moves its vertices.
pub(crate) fn delete_selected(workspace: &mut Workspace) {
    let Some(handle) = workspace.selected() else { return };
    let (id, name) = (handle.id, format!("Delete {}", handle.name));
    let becomes_pin = handle.is_displaced() && !handle.is_pin;
    workspace.jobs.drop_solves();
    workspace.change(name, |document| {
        document.keep_shape();
        if becomes_pin {
            document.change_handle(id, Handle::pin);
        } else {
            let freed = members(document, id).into_iter().map(|vertex| (vertex, Paint::Bare));
            document.paint_vertices(freed.collect::<Vec<_>>());
            document.change_handles(|handles| {
                let former = handles.clone();
                handles.retain(|handle| handle.id != id);
                find_parents_anew(handles, &former);
            });
        }
        document.change_handles(|handles| {
            for handle in handles {
                handle.twin = handle.twin.filter(|twin| twin.handle != id);
            }
        });
    });
}

/// Pins the selected handle, or unpins it.
pub(crate) fn pin_or_unpin_selected(workspace: &mut Workspace) {
    let Some(handle) = workspace.selected() else { return };
    let id = handle.id;
    let is_pin = handle.is_pin;
    workspace.jobs.drop_solves();
    workspace.change(if is_pin { "Unpin" } else { "Pin" }, |document| {
        document.keep_shape();
        document.change_handle(id, |handle| {
            if is_pin {
                handle.is_pin = false;
                handle.name = format!("handle {}", u32::from(id.0) + 1);
                handle.reach = Reach::default();
            } else {
                handle.pin();
            }
        });
        document.change_handles(|handles| {
            for handle in handles {
                handle.twin = handle.twin.filter(|twin| is_pin || twin.handle != id);
            }
        });
    });
}

/// Chooses the place of a pivot, and moves it there.
pub(crate) fn set_pivot_place(workspace: &mut Workspace, id: HandleId, place: PivotPlace) {
    let Some(model) = workspace.model().cloned() else {
        return;
    };
    let document = &workspace.document;
    let position = |vertex: usize| model.surface.positions[vertex] + document.rest[vertex];
    let members = (0..document.paint.len()).filter(|&vertex| document.paint[vertex] == Paint::Handle(id));
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for vertex in members {
        sum += position(vertex);
        count += 1.0;
    }
    let pivot = match place {
        PivotPlace::Centroid => (count > 0.0).then(|| sum / count),
        PivotPlace::Border => border_middle(id, &document.paint, &model, &position),
        PivotPlace::Picked => None,
    };
    change_handle(workspace, "Choose pivot", id, |handle| {
        handle.pivot_place = place;
        if let Some(pivot) = pivot {
            handle.move_pivot(pivot);
        }
    });
}

/// Moves a pivot to a point of the present shape.
pub(crate) fn set_pivot(workspace: &mut Workspace, id: HandleId, point: DVec3) {
    if !point.is_finite() {
        workspace.refuse("The pivot is not finite: enter other numbers.");
        return;
    }
    change_handle(workspace, "Put pivot", id, |handle| {
        let affine = handle.affine();
        let inverse = affine.inverse();
        // A handle scaled to zero has no inverse: only the pivot's displacement is known.
        let rest = if inverse.is_finite() {
            inverse.transform_point3(point)
        } else {
            handle.pivot + (point - handle.centre())
        };
        handle.pivot_place = PivotPlace::Picked;
        handle.move_pivot(rest);
    });
}

/// Splits the selected handle in two across its longest side.
pub(crate) fn split_selected(workspace: &mut Workspace) {
    let (Some(id), Some(model)) = (workspace.selection.selected(), workspace.model().cloned()) else {
        return;
    };
    let members: Vec<usize> = (0..workspace.document.paint.len())
        .filter(|&vertex| workspace.document.paint[vertex] == Paint::Handle(id))
        .collect();
    let positions: Vec<DVec3> = members
        .iter()
        .map(|&vertex| model.surface.positions[vertex] + workspace.document.from_file[vertex])
        .collect();
    let Some(bounds) = pliant_mesh::bounding_box(&positions) else {
        return;
    };
    let extent = bounds.extent();
    let axis = (0..3).fold(0, |best, axis| if extent[axis] > extent[best] { axis } else { best });
    let middle = bounds.centre()[axis];
    let target = Paint::Handle(HandleId(workspace.document.next_handle));
    let changes: Vec<(usize, Paint)> = members
        .iter()
        .zip(&positions)
        .filter(|(_, position)| position[axis] > middle)
        .map(|(&vertex, _)| (vertex, target))
        .collect();
    if changes.is_empty() || changes.len() == members.len() {
        workspace.refuse("A handle of one point can't be split: paint more of it.");
        return;
    }
    repaint(workspace, "Split handle".to_owned(), Paint::Handle(id), target, changes);
}

/// Separates the selected handle from its twin.
pub(crate) fn untwin(workspace: &mut Workspace) {
    let Some(id) = workspace.selection.selected() else {
        return;
    };
    workspace.change("Part twins", |document| {
        let twin = document.change_handle(id, |handle| handle.twin.take());
        if let Some(twin) = twin.flatten() {
            document.change_handle(twin.handle, |other| other.twin = None);
        }
    });
}

/// Takes the selected handle's vertices and the free ones around them back to the file's shape.
pub(crate) fn reset_region(workspace: &mut Workspace) {
    let (Some(id), Some(model)) = (workspace.selection.selected(), workspace.model().cloned()) else {
        return;
    };
    // The free vertices connected to the handle's.
    let is_own = |vertex: usize| workspace.document.paint[vertex] == Paint::Handle(id);
    let mut taken: Vec<bool> = (0..workspace.document.paint.len()).map(is_own).collect();
    let mut stack: Vec<usize> = (0..taken.len()).filter(|&vertex| taken[vertex]).collect();
    while let Some(vertex) = stack.pop() {
        for neighbour in model.topology.neighbours(SurfaceVertex(vertex as u32)) {
            let next = neighbour.index();
            if !taken[next] && workspace.computed().region.roles.get(next) == Some(&Role::Free) {
                taken[next] = true;
                stack.push(next);
            }
        }
    }
    workspace.jobs.drop_solves();
    workspace.step("Reset region", |workspace| {
        let before = workspace.document.clone();
        let document = &mut workspace.document;
        document.change_handle(id, Handle::come_to_rest);
        document.forget_shape_at(&taken);
        let members = members(document, id);
        let position = |vertex: &SurfaceVertex| model.surface.positions[vertex.index()] + document.rest[vertex.index()];
        let middle = members.iter().map(position).sum::<DVec3>() / members.len().max(1) as f64;
        document.change_handle(id, |handle| {
            if handle.pivot_place != PivotPlace::Picked {
                handle.pivot = middle;
            }
        });
        tidy_handles(workspace, &before);
    });
}
