//! The limb under the pointer, and the search for its joint.

use std::collections::BTreeMap;
use std::sync::Arc;

use pliant_mesh::{Joint, Shape, joint_of};

use crate::document::{Document, HandleId, Paint};
use crate::jobs::JobKind;
use crate::view::{Pick, View};
use crate::workspace::Workspace;

/// The limb under the pose brush at a point of the surface.
#[derive(Clone, Debug)]
pub(crate) enum Limb {
    /// A limb that already has a handle.
    Posed(HandleId),
    /// A limb without one.
    Untouched(Arc<Joint>),
    /// The search for its joint is running.
    Unknown,
    /// There is no joint.
    None,
}

/// Requests the joint of the limb under the pointer, if it is not known yet.
pub(crate) fn hover(workspace: &mut Workspace, view: &View, pointer_px: Option<glam::DVec2>) {
    if !workspace.jobs.is_picking_current() {
        return;
    }
    let pick = pointer_px.and_then(|px| workspace.pick(view, px));
    let Some(pick) = pick else {
        return workspace.jobs.forget_joint();
    };
    if handle_at(&workspace.document, &pick).is_some() || !workspace.jobs.asks_for_joint(pick.triangle) {
        return;
    }
    let Some(model) = workspace.model().cloned() else {
        return;
    };
    let displacements = Arc::clone(workspace.document.from_file());
    workspace.jobs.look_for_joint(
        pick.triangle,
        Box::new(move |_, cancel| {
            let rest = model.surface.positions.iter().zip(&**displacements);
            let positions: Vec<_> = rest.map(|(&rest, &moved)| rest + moved).collect();
            let shape = Shape {
                triangles: &model.surface.triangles,
                topology: &model.topology,
                positions: &positions,
            };
            Ok(joint_of(&shape, pick.triangle, pick.point, cancel)?.map(Arc::new))
        }),
    );
}

/// The limb at a point of the surface: the handle there, or the limb of the shown joint, or of a handle on its far
/// side.
pub(crate) fn limb_under(workspace: &Workspace, pick: &Pick) -> Limb {
    let document = &workspace.document;
    if let Some(id) = handle_at(document, pick) {
        return Limb::Posed(id);
    }
    match workspace.computed().joint() {
        Some(joint) if joint.limb.binary_search(&pick.vertex).is_ok() => match handle_on(document, joint) {
            Some(id) => Limb::Posed(id),
            None => Limb::Untouched(Arc::clone(joint)),
        },
        _ if workspace.jobs.is_busy(JobKind::Joint) => Limb::Unknown,
        _ => Limb::None,
    }
}

/// The handle at a point of the surface, except pins.
fn handle_at(document: &Document, pick: &Pick) -> Option<HandleId> {
    match document.paint()[pick.vertex.index()] {
        Paint::Handle(id) => document
            .handle(id)
            .filter(|handle| !handle.is_pin)
            .map(|handle| handle.id),
        _ => None,
    }
}

/// The handle with the most vertices on the far side of a joint.
fn handle_on(document: &Document, joint: &Joint) -> Option<HandleId> {
    let mut counts: BTreeMap<HandleId, usize> = BTreeMap::new();
    for vertex in &joint.far_side {
        if let Paint::Handle(id) = document.paint()[vertex.index()]
            && document.handle(id).is_some_and(|handle| !handle.is_pin)
        {
            *counts.entry(id).or_default() += 1;
        }
    }
    // The first of equal ones.
    let most = counts.into_iter().rev().max_by_key(|(_, count)| *count);
    most.map(|(id, _)| id)
}
