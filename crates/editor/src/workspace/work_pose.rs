//! Working in a temporary pose: its beginning, its corrections, its end.

use glam::{DMat3, DVec3};
use pliant_mesh::{Model, SurfaceVertex};
use rayon::prelude::*;

use super::painting::transform_as_seen;
use super::state::Workspace;
use crate::document::{Document, bits_equal, polar_decomposition};

/// Begins a work pose, or returns from it.
pub(crate) fn toggle_work_pose(workspace: &mut Workspace) {
    let Some(model) = workspace.model().cloned() else {
        return;
    };
    if workspace.document.work_pose().is_some() {
        workspace.jobs.drop_solves();
        workspace.change("Return from work pose", |document| leave(document, &model));
    } else {
        workspace.change("Work pose", Document::enter_work_pose);
    }
}

/// The document outside its work pose, which is what files get.
pub(crate) fn lasting(document: &Document, model: &Model) -> Document {
    let mut document = document.clone();
    leave(&mut document, model);
    document
}

fn leave(document: &mut Document, model: &Model) {
    document.leave_work_pose(|document, handle| transform_as_seen(document, model, handle.id, handle.pivot));
}

/// Adds the corrections of a stroke, which began with the document `before`, to those that stay when the work pose is
/// left.
pub(crate) fn carry_corrections(workspace: &mut Workspace, before: &Document) {
    let Some(model) = workspace.model().cloned() else {
        return;
    };
    let document = &mut workspace.document;
    let Some(work) = document.work_pose() else { return };
    let (own, posed, now) = (&work.before.from_rest, before.from_rest(), document.from_rest());
    let rest = |vertex: usize| model.surface.positions[vertex] + document.rest()[vertex];
    let former = work.corrected.as_deref();
    let corrected = (0..now.len()).into_par_iter().with_min_len(1 << 12).map(|vertex| {
        let so_far = former.map_or(DVec3::ZERO, |corrected| corrected[vertex]);
        if bits_equal(now[vertex], posed[vertex]) {
            return so_far;
        }
        let edge = |shape: &[DVec3], to: usize| rest(to) + shape[to] - rest(vertex) - shape[vertex];
        let mut turned = DMat3::ZERO;
        for neighbour in model.topology.neighbours(SurfaceVertex(vertex as u32)) {
            let to = neighbour.index();
            let (from, to) = (edge(own, to), edge(posed, to));
            turned += DMat3::from_cols(to * from.x, to * from.y, to * from.z);
        }
        let (rotation, _) = polar_decomposition(turned);
        so_far + rotation.inverse() * (now[vertex] - posed[vertex])
    });
    let corrected = corrected.collect();
    document.note_corrected(corrected);
}
