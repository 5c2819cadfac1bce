//! Choices for the document as a whole: method, loose parts, stiffness; and the reset of its shape.

use std::collections::BTreeMap;
use std::sync::Arc;

use pliant_deform::{Attachment, Loose, Method};

use super::painting::members;
use super::state::Workspace;
use crate::document::{Document, Tips};
use crate::format::STRENGTH_RANGE;
use crate::region::centroid;

/// Makes the present shape the new rest shape.
pub(crate) fn apply_shape(workspace: &mut Workspace) {
    workspace.change("Apply shape", Document::apply_shape);
    workspace.jobs.drop_solves();
}

/// Takes the rest shape and every handle back to the file's shape.
pub(crate) fn reset_shape(workspace: &mut Workspace) {
    let Some(model) = workspace.model().cloned() else {
        return;
    };
    workspace.jobs.drop_solves();
    workspace.change("Reset shape", |document| {
        let was_applied = document.is_applied();
        document.forget_shapes();
        let rested = at_rest(document);
        document.set_attachments(rested);
        document.rest_examples();
        let positions = &model.surface.positions;
        let pivot = |id| centroid(positions, members(document, id).into_iter());
        let pivots: Vec<_> = document.handles().iter().map(|handle| pivot(handle.id)).collect();
        document.change_handles(|handles| {
            for (handle, pivot) in handles.iter_mut().zip(pivots) {
                handle.come_to_rest();
                if was_applied {
                    handle.pivot = pivot;
                }
            }
        });
    });
}

/// The document's attachments with the present method's control points at rest.
pub(super) fn at_rest(document: &Document) -> Arc<BTreeMap<&'static str, Attachment>> {
    let mut attachments = Arc::clone(&document.attachments);
    if document.moved_controls().is_some()
        && let Some((name, own)) = document.attachment()
    {
        let rested = own.with_moved(Arc::new(document.method().control_rest(own)));
        Arc::make_mut(&mut attachments).insert(name, rested);
    }
    attachments
}

/// Shows a share (0 to 1) of the whole edit.
pub(crate) fn set_strength(workspace: &mut Workspace, share: f64) {
    if !STRENGTH_RANGE.contains(&share) {
        workspace.refuse("The strength is out of range: enter 0 to 100 percent.");
        return;
    }
    workspace.change("Change strength", |document| document.set_strength(share));
}

/// Removes all handles and regions; the shape does not change.
pub(crate) fn clear_regions(workspace: &mut Workspace) {
    workspace.jobs.drop_solves();
    workspace.change("Clear regions", |document| {
        document.apply_shape();
        document.clear_paint();
    });
}

/// Chooses the method and its options.
pub(crate) fn set_method(workspace: &mut Workspace, method: Method) {
    workspace.change("Change method", |document| {
        if *document.method() != method {
            document.unsettle_if_displaced();
            let attachments = carried_over(document, &method);
            document.set_method(method);
            document.set_attachments(attachments);
            document.unsettle_if_displaced();
        }
    });
}

/// The document's attachments for another method or other options: the rest positions of a lattice's points depend on
/// its functions, and points moved by hand keep their displacements.
fn carried_over(document: &Document, method: &Method) -> Arc<BTreeMap<&'static str, Attachment>> {
    let mut attachments = Arc::clone(&document.attachments);
    if let Some((name, own)) = document.attachment()
        && method.declaration().attachment(name).is_some()
    {
        let (before, after) = (document.method().control_rest(own), method.control_rest(own));
        if before != after && before.len() == after.len() {
            let moved = own.moved().map_or(&[][..], |moved| moved);
            let places = moved.iter().zip(&before).zip(&after);
            let moved = places.map(|((moved, before), after)| *after + (*moved - *before));
            let carried = own.with_moved(Arc::new(moved.collect()));
            Arc::make_mut(&mut attachments).insert(name, carried);
        }
    }
    attachments
}

/// Chooses whether the parts that a reach cuts off from the body are free.
pub(crate) fn set_tips(workspace: &mut Workspace, tips: Tips) {
    let name = match tips {
        Tips::ComeAlong => "Free tips",
        Tips::Held => "Fix tips",
    };
    workspace.change(name, |document| {
        if document.tips() != tips {
            document.unsettle_if_displaced();
            document.set_tips(tips);
        }
    });
}

/// Chooses the behaviour of all components that nothing holds.
pub(crate) fn set_loose(workspace: &mut Workspace, loose: Loose) {
    workspace.change("Change loose parts", |document| {
        put_loose(document, loose, BTreeMap::new());
    });
}

/// Chooses the behaviour of one of them, by its component's number; `None` is the behaviour of all.
pub(crate) fn set_loose_part(workspace: &mut Workspace, part: u32, loose: Option<Loose>) {
    let count = workspace.model().map_or(0, |model| model.topology.components().len());
    if part as usize >= count {
        workspace.refuse(format!("The mesh has only {count} parts: choose one from the list."));
        return;
    }
    workspace.change("Change loose part", |document| {
        let mut parts = document.loose_parts().clone();
        match loose {
            Some(loose) => parts.insert(part, loose),
            None => parts.remove(&part),
        };
        put_loose(document, document.loose(), parts);
    });
}

fn put_loose(document: &mut Document, loose: Loose, parts: BTreeMap<u32, Loose>) {
    if document.loose() != loose || *document.loose_parts() != parts {
        document.unsettle_if_displaced();
        document.set_loose(loose, parts);
    }
}
