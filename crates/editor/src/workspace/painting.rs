//! The common code of all changes of paint: the vertices of a role, painting in a step, and the consequences for
//! handles.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{RigidMotion, Role};
use pliant_mesh::{Model, SurfaceVertex};

use super::state::Workspace;
use crate::document::{Aspect, Document, Handle, HandleId, HandleTransform, Paint, PivotPlace, find_parents_anew};

/// The vertices of a handle, ascending.
pub(crate) fn members(document: &Document, id: HandleId) -> Vec<SurfaceVertex> {
    let painted = document.paint().iter().zip(0..);
    painted
        .filter(|(paint, _)| **paint == Paint::Handle(id))
        .map(|(_, vertex)| SurfaceVertex(vertex))
        .collect()
}

/// The vertices with a role; for the free region also those that a reach has freed.
pub(crate) fn members_of(workspace: &Workspace, role: Paint) -> Vec<bool> {
    let paint = &workspace.document.paint;
    let mut is_member: Vec<bool> = paint.iter().map(|paint| *paint == role).collect();
    if role == Paint::Free {
        let freed = paint.iter().zip(workspace.computed().region.roles.iter());
        for (is_member, (paint, role)) in is_member.iter_mut().zip(freed) {
            *is_member |= *paint == Paint::Bare && *role == Role::Free;
        }
    }
    is_member
}

/// The name of a role's region.
pub(super) fn name_of(workspace: &Workspace, role: Paint) -> String {
    match role {
        Paint::Handle(id) => {
            let handle = workspace.document.handle(id);
            handle.map_or(String::new(), |handle| handle.name.clone())
        }
        Paint::Free => "region".to_owned(),
        Paint::Fixed => "fixed part".to_owned(),
        Paint::Bare => "bare part".to_owned(),
    }
}

/// Paints vertices in one step; vertices of handles other than `role`'s do not change. `target` may be a handle that
/// does not exist yet.
pub(crate) fn repaint(
    workspace: &mut Workspace,
    name: String,
    role: Paint,
    target: Paint,
    changes: Vec<(usize, Paint)>,
) {
    let document = &workspace.document;
    let changes: Vec<(usize, Paint)> = changes
        .into_iter()
        .filter(|&(vertex, paint)| {
            let present = document.paint[vertex];
            present != paint
                && workspace.vertex_access.may_be_painted(vertex)
                && (present == role || !matches!(present, Paint::Handle(_)))
        })
        .collect();
    if changes.is_empty() {
        return;
    }
    workspace.jobs.drop_solves();
    let mut made = None;
    workspace.step(name, |workspace| {
        let before = workspace.document.clone();
        workspace.document.keep_shape();
        if let Paint::Handle(id) = target
            && workspace.document.handle(id).is_none()
        {
            made = Some(workspace.document.add_handle());
        }
        let changes = changes.into_iter();
        let changes = changes.map(|(vertex, paint)| (SurfaceVertex(vertex as u32), paint));
        workspace.document.paint_vertices(changes);
        tidy_handles(workspace, &before);
    });
    if made.is_some() {
        workspace.selection.put(made);
    }
}

/// Called after changes of regions: removes handles without a vertex, moves the pivot of each handle at rest with
/// changed vertices to their mean, and makes new regions on a bent shape handles or pins at their visible positions.
pub(crate) fn tidy_handles(workspace: &mut Workspace, before: &Document) {
    let Some(model) = workspace.model().cloned() else {
        return;
    };
    let document = &mut workspace.document;
    if !document.versions().differ(before.versions(), Aspect::Paint) {
        document.drop_handles_made_since(before);
        return;
    }
    pin_what_is_held_elsewhere(document, before);
    let numbers = document.handles().iter().map(|handle| usize::from(handle.id.0) + 1);
    let mut sums = vec![(DVec3::ZERO, 0.0, false); numbers.max().unwrap_or(0)];
    let (paint, rest) = (Arc::clone(&document.paint), Arc::clone(&document.rest));
    let position = |vertex: usize| model.surface.positions[vertex] + rest[vertex];
    for (vertex, (&paint, &former)) in paint.iter().zip(before.paint()).enumerate() {
        if let Paint::Handle(HandleId(id)) = paint {
            let (sum, count, _) = &mut sums[usize::from(id)];
            *sum += position(vertex);
            *count += 1.0;
        }
        if paint != former {
            for touched in [paint, former] {
                if let Paint::Handle(HandleId(id)) = touched
                    && let Some((_, _, changed)) = sums.get_mut(usize::from(id))
                {
                    *changed = true;
                }
            }
        }
    }
    document.change_handles(|handles| {
        let former = handles.clone();
        handles.retain_mut(|handle| {
            let (sum, count, changed) = sums[usize::from(handle.id.0)];
            // A turned handle's numbers are about its pivot: they keep their values.
            if changed && count > 0.0 && !handle.is_displaced() {
                handle.pivot = match handle.pivot_place {
                    PivotPlace::Centroid => sum / count,
                    PivotPlace::Border => border_middle(handle.id, &paint, &model, &position).unwrap_or(sum / count),
                    PivotPlace::Picked => handle.pivot,
                };
            }
            count > 0.0
        });
        find_parents_anew(handles, &former);
        let left: Vec<HandleId> = handles.iter().map(|handle| handle.id).collect();
        for handle in handles {
            handle.twin = handle.twin.filter(|twin| left.contains(&twin.handle));
        }
    });
    if document.kept.is_some() {
        put_new_handles_where_they_are_seen(document, before, &model);
        document.keep_shape();
    }
}

/// Vertices that a stroke fixes away from rest become a pin: they keep their visible positions.
fn pin_what_is_held_elsewhere(document: &mut Document, before: &Document) {
    if !document.is_displaced() {
        return;
    }
    let paint = document.paint.iter().zip(before.paint());
    let held: Vec<usize> = paint
        .zip(document.from_rest())
        .enumerate()
        .filter(|(_, ((paint, former), moved))| {
            **paint == Paint::Fixed && **former != Paint::Fixed && **moved != DVec3::ZERO
        })
        .map(|(vertex, _)| vertex)
        .collect();
    if held.is_empty() {
        return;
    }
    let id = document.add_handle();
    document.change_handle(id, Handle::pin);
    document.paint_vertices(
        held.into_iter()
            .map(|vertex| (SurfaceVertex(vertex as u32), Paint::Handle(id))),
    );
}

/// Gives each new handle the transform that leads to its vertices' visible positions: that of their former handle, if
/// all had the same one, or the rigid motion that fits best.
fn put_new_handles_where_they_are_seen(document: &mut Document, before: &Document, model: &Model) {
    let is_new = |handle: &&Handle| before.handle(handle.id).is_none();
    let new: Vec<(HandleId, DVec3)> = document
        .handles()
        .iter()
        .filter(is_new)
        .map(|handle| (handle.id, handle.pivot))
        .collect();
    for (id, pivot) in new {
        let members = members(document, id);
        let former = members.first().map(|vertex| before.paint[vertex.index()]);
        let parent = match former {
            Some(Paint::Handle(parent))
                if members
                    .iter()
                    .all(|vertex| before.paint[vertex.index()] == Paint::Handle(parent)) =>
            {
                before.handle(parent)
            }
            _ => None,
        };
        if let Some(parent) = parent {
            document.change_handle(id, |handle| {
                handle.pivot = parent.pivot;
                handle.put(parent.transform);
                handle.move_pivot(pivot);
            });
            continue;
        }
        if let Some(transform) = transform_as_seen(document, model, id, pivot) {
            document.change_handle(id, |handle| handle.put(transform));
        }
    }
}

/// The rigid motion that fits the visible positions of a handle's vertices best, about its pivot; `None` if it has no
/// vertices.
pub(super) fn transform_as_seen(
    document: &Document,
    model: &Model,
    id: HandleId,
    pivot: DVec3,
) -> Option<HandleTransform> {
    let members = members(document, id);
    let moved: Vec<DVec3> = members
        .iter()
        .map(|vertex| document.from_rest[vertex.index()])
        .collect();
    if moved.iter().all(|moved| *moved == DVec3::ZERO) {
        return Some(HandleTransform::IDENTITY);
    }
    let rest = members
        .iter()
        .map(|vertex| model.surface.positions[vertex.index()] + document.rest[vertex.index()]);
    let motion = RigidMotion::fit(&rest.collect::<Vec<_>>(), &moved)?;
    Some(HandleTransform::Trs {
        translation: motion.displace(pivot),
        rotation: motion.rotation(),
        scale: DVec3::ONE,
        pivot: None,
    })
}

/// The mean of a handle's vertices that are beside others; `None` if it covers whole parts.
pub(crate) fn border_middle(
    id: HandleId,
    paint: &[Paint],
    model: &Model,
    position: &impl Fn(usize) -> DVec3,
) -> Option<DVec3> {
    let own = Paint::Handle(id);
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for vertex in (0..paint.len()).filter(|&vertex| paint[vertex] == own) {
        let neighbours = model.topology.neighbours(SurfaceVertex(vertex as u32));
        if neighbours.iter().any(|neighbour| paint[neighbour.index()] != own) {
            sum += position(vertex);
            count += 1.0;
        }
    }
    (count > 0.0).then(|| sum / count)
}
