//! The mirror image of a region: a job searches for it, because every vertex needs the nearest one across the plane.
//!
//! The action on the image waits meanwhile. If the paint has changed when it arrives, nothing is done, and a message
//! says so.

use pliant_mesh::{Bvh, Cancel, Cancelled, MirrorPlane, Model, Progress, SurfaceVertex, image_of};
use rayon::prelude::*;

use super::mirror_request::{Mirroring, Purpose};
use super::painting::{members_of, name_of, repaint};
use super::state::Workspace;
use crate::document::{Aspect, HandleId, Paint, link_twins};

/// The number of vertices between two updates of the progress.
const BATCH: usize = 16_384;

/// Requests the mirror image of a role's vertices.
pub(crate) fn mirror(workspace: &mut Workspace, purpose: Purpose, axis: usize) {
    let (Some(model), Some(plane)) = (workspace.model().cloned(), mirror_plane(workspace, axis)) else {
        return;
    };
    let role = match purpose {
        Purpose::Region(role) => role,
        Purpose::Twin(id) => Paint::Handle(id),
    };
    let is_member = members_of(workspace, role);
    let bvh = rest_bvh(workspace);
    workspace.mirroring = Some(Mirroring {
        purpose,
        plane,
        paint: workspace.document.versions().of(Aspect::Paint),
    });
    let work = Box::new(move |progress: &_, cancel: &_| {
        let bvh = bvh.unwrap_or_else(|| Bvh::build(&model.surface.positions, &model.surface.triangles));
        Ok(mirrored(&model, &bvh, &is_member, plane, progress, cancel)?)
    });
    workspace.jobs.ask(|slots| &mut slots.mirror, work);
}

/// Executes the action on an image, if no gesture is active and the paint is unchanged.
pub(crate) fn take_mirrored(workspace: &mut Workspace, is_idle: bool) {
    let image = workspace.jobs.computed.slots.mirror.take();
    let (Some(image), Some(Mirroring { purpose, plane, paint })) = (image, workspace.mirroring.take()) else {
        return;
    };
    let is_other = workspace.document.versions().of(Aspect::Paint) != paint;
    if is_other || !is_idle {
        workspace.refuse("The regions changed while the mirror image was computed: mirror again.");
        return;
    }
    match purpose {
        Purpose::Region(role) => mirror_region(workspace, role, image),
        Purpose::Twin(id) => twin_of(workspace, id, &image, plane),
    }
}

/// Adds a region's mirror image to it.
fn mirror_region(workspace: &mut Workspace, role: Paint, image: Vec<usize>) {
    let changes = image.into_iter().map(|vertex| (vertex, role)).collect();
    repaint(
        workspace,
        format!("Mirror {}", name_of(workspace, role)),
        role,
        role,
        changes,
    );
}

/// Makes the image of a handle's vertices its twin.
fn twin_of(workspace: &mut Workspace, id: HandleId, image: &[usize], plane: MirrorPlane) {
    let image: Vec<usize> = image
        .iter()
        .copied()
        .filter(|&vertex| workspace.vertex_access.may_be_painted(vertex))
        .filter(|&vertex| !matches!(workspace.document.paint[vertex], Paint::Handle(_)))
        .collect();
    if image.is_empty() {
        workspace.refuse(
            "The handle's mirror image has no vertex that can become its twin: choose another axis, or paint the \
             twin.",
        );
        return;
    }
    workspace.jobs.drop_solves();
    workspace.change("Make twin", |document| {
        document.keep_shape();
        let other = document.add_handle();
        let painted = image.iter().map(|&vertex| SurfaceVertex(vertex as u32));
        document.paint_vertices(painted.map(|vertex| (vertex, Paint::Handle(other))));
        link_twins(document, id, other, plane);
    });
}

/// The hierarchy of the file's own shape, if it exists.
pub(super) fn rest_bvh(workspace: &Workspace) -> Option<Bvh> {
    let is_as_in_file = !workspace.document.applied && !workspace.document.is_displaced();
    let ready = workspace.computed().pickable();
    ready
        .filter(|pickable| is_as_in_file && pickable.shown.triangles.is_none() && workspace.jobs.is_picking_current())
        .map(|pickable| pickable.bvh.clone())
}

/// The plane through the middle of the model's rest shape, across an axis.
pub(super) fn mirror_plane(workspace: &Workspace, axis: usize) -> Option<MirrorPlane> {
    let axis = axis.min(2);
    let bounds = workspace.model()?.bounds()?;
    Some(MirrorPlane::across(axis, bounds.centre()[axis]))
}

/// The vertices whose mirror image on the file's shape is nearest to a member and no farther from it than its longest
/// edge, ascending.
fn mirrored(
    model: &Model,
    bvh: &Bvh,
    is_member: &[bool],
    plane: MirrorPlane,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Vec<usize>, Cancelled> {
    let positions = &model.surface.positions;
    let members = (0..is_member.len()).filter(|&vertex| is_member[vertex]);
    let images: Vec<_> = members.map(|vertex| plane.mirrored(positions[vertex])).collect();
    let Some(bounds) = pliant_mesh::bounding_box(&images) else {
        return Ok(Vec::new());
    };
    let margin = 0.05 * bounds.diagonal();
    let near = |p: glam::DVec3| p.cmpge(bounds.min - margin).all() && p.cmple(bounds.max + margin).all();
    let is_image = |vertex: &usize| {
        let position = positions[*vertex];
        if is_member[*vertex] || !near(position) {
            return false;
        }
        let image = image_of(positions, &model.topology, bvh, plane, SurfaceVertex(*vertex as u32));
        image.is_some_and(|image| is_member[image.index()])
    };
    let mut found = Vec::new();
    for start in (0..is_member.len()).step_by(BATCH) {
        cancel.check()?;
        let batch = start..(start + BATCH).min(is_member.len());
        found.par_extend(batch.into_par_iter().filter(is_image));
        progress.set(start as f32 / is_member.len() as f32);
    }
    Ok(found)
}
