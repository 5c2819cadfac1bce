//! The mirror image of a region: looked for by a job, since every vertex asks for the nearest one across the plane.
//!
//! What is done with the image waits meanwhile. If the paint has changed when it comes, nothing is done, and that is
//! said.

use std::sync::Arc;

use pliant_mesh::{Bvh, Cancel, Cancelled, Model, Progress};
use rayon::prelude::*;

use crate::document::{HandleId, MirrorPlane, Paint};
use crate::editor::Editor;

/// How many vertices are asked between two looks at the progress.
const BATCH: usize = 16_384;

/// What an image is wanted for.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Purpose {
    /// To be taken into the region that it is the image of.
    Region(Paint),
    /// To become a twin of the handle.
    Twin(HandleId),
}

/// An image that is being looked for.
#[derive(Debug)]
pub(crate) struct Mirroring {
    purpose: Purpose,
    plane: MirrorPlane,
    /// The paint that it was asked of.
    paint: Arc<Vec<Paint>>,
}

impl Editor {
    /// Has the mirror image of a role's vertices looked for.
    pub(crate) fn mirror(&mut self, purpose: Purpose, axis: usize) {
        let (Some(model), Some(plane)) = (self.engine.model.clone(), self.mirror_plane(axis)) else {
            return;
        };
        let role = match purpose {
            Purpose::Region(role) => role,
            Purpose::Twin(id) => Paint::Handle(id),
        };
        let is_member = self.members_of(role);
        let is_as_in_file = !self.document.applied && !self.document.is_displaced();
        let ready = self.engine.pickable.as_ref();
        let bvh = ready
            .filter(|pickable| is_as_in_file && pickable.triangles.is_none() && self.engine.is_picking_current())
            .map(|pickable| pickable.bvh.clone());
        self.mirroring = Some(Mirroring {
            purpose,
            plane,
            paint: Arc::clone(&self.document.paint),
        });
        self.engine.mirror(Box::new(move |progress, cancel| {
            let bvh = bvh.unwrap_or_else(|| Bvh::build(&model.surface.positions, &model.surface.triangles));
            match mirrored(&model, &bvh, &is_member, plane, progress, cancel) {
                Ok(image) => crate::JobOutcome::Mirrored(image),
                Err(_) => crate::JobOutcome::Cancelled,
            }
        }));
    }

    /// Does what an image was wanted for.
    pub(crate) fn take_mirrored(&mut self, image: Vec<usize>) {
        let Some(Mirroring { purpose, plane, paint }) = self.mirroring.take() else {
            return;
        };
        if !Arc::ptr_eq(&paint, &self.document.paint) || !matches!(self.tool, crate::tool::Tool::Idle) {
            self.problem =
                Some("The regions have changed while the mirror image was looked for: mirror again.".to_owned());
            return;
        }
        match purpose {
            Purpose::Region(role) => self.mirror_region(role, image),
            Purpose::Twin(id) => self.twin_of(id, &image, plane),
        }
    }

    /// The plane through the middle of the model's rest shape, across an axis.
    fn mirror_plane(&self, axis: usize) -> Option<MirrorPlane> {
        let axis = axis.min(2);
        let bounds = self.engine.model.as_ref()?.bounds()?;
        Some(MirrorPlane {
            axis,
            at: bounds.centre()[axis],
        })
    }
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
        bvh.nearest_vertex(plane.mirrored(position))
            .is_some_and(|(nearest, distance)| {
                let here = positions[nearest.index()];
                let neighbours = model.topology.neighbours(nearest).iter();
                let longest = neighbours
                    .map(|v| here.distance(positions[v.index()]))
                    .fold(0.0, f64::max);
                is_member[nearest.index()] && distance <= longest
            })
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
