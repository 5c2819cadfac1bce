//! The beginning and the end of a work pose.

use std::sync::Arc;

use glam::DVec3;

use super::Document;
use crate::document::content::WorkPose;
use crate::document::handle::Handle;
use crate::document::handle_transform::HandleTransform;
use crate::document::pose::Placed;
use crate::document::version::Aspect;

impl Document {
    /// Returns true if the document is in a work pose, from which it returns exactly.
    pub fn is_in_work_pose(&self) -> bool {
        self.content.work_pose.is_some()
    }

    /// The state to which the document returns from its work pose, if it is in one.
    pub(crate) fn work_pose(&self) -> Option<&Arc<WorkPose>> {
        self.content.work_pose.as_ref()
    }

    /// Begins a work pose. Nothing moves.
    pub(crate) fn enter_work_pose(&mut self) {
        self.content.work_pose = Some(Arc::new(WorkPose {
            before: self.content.clone(),
            versions: *self.versions(),
            corrected: None,
        }));
    }

    /// Notes corrections that were made in the work pose, as displacements of the shape at its beginning.
    pub(crate) fn note_corrected(&mut self, corrected: Vec<DVec3>) {
        if let Some(work) = &mut self.content.work_pose {
            Arc::make_mut(work).corrected = Some(Arc::new(corrected));
        }
    }

    /// Returns from the work pose: handles, control points and shape are those at its beginning, and the corrections
    /// since then are added. Handles that were made in it get the transform of `fit`, which leads to their vertices'
    /// positions in that shape.
    pub(crate) fn leave_work_pose(&mut self, fit: impl Fn(&Self, &Handle) -> Option<HandleTransform>) {
        let Some(work) = self.content.work_pose.take() else {
            return;
        };
        let before = &work.before;
        let is_other_problem = self.versions().are_other_problem(&work.versions);
        self.restore_attachments(&work);
        self.content.from_rest = match &work.corrected {
            None => Arc::clone(&before.from_rest),
            Some(corrected) => Arc::new(sum(&before.from_rest, corrected)),
        };
        self.content.sum_shapes();
        self.content.corrections = match (&before.corrections, &work.corrected) {
            (Some(former), Some(corrected)) => Some(Arc::new(sum(former, corrected))),
            (former, corrected) => former.clone().or_else(|| corrected.clone()),
        };
        self.marks.mark(&[Aspect::Shape, Aspect::Drawn]);
        let former = |handle: &Handle| before.handles.iter().find(|former| former.id == handle.id);
        let new = |handle: &Handle| match former(handle) {
            None => fit(self, handle),
            Some(_) => None,
        };
        let fitted: Vec<Option<HandleTransform>> = self.handles().iter().map(new).collect();
        self.change_handles(|handles| {
            for (handle, fitted) in handles.iter_mut().zip(fitted) {
                match former(handle) {
                    Some(former) => restore(handle, former),
                    None => handle.put(fitted.unwrap_or(HandleTransform::IDENTITY)),
                }
            }
        });
        self.content.strength = before.strength.clone().filter(|_| !is_other_problem);
        self.content.settled = true;
        self.content.kept = before.kept.clone();
        if is_other_problem || work.corrected.is_some() {
            self.content.kept = None;
            if self.is_moved() || self.content.from_rest.iter().any(|moved| *moved != DVec3::ZERO) {
                self.content.kept = Some(Arc::new(self.seen()));
            }
        }
        self.keep_way();
    }

    /// The attachments' points and weights of the beginning, for those whose rest state is still the same.
    fn restore_attachments(&mut self, work: &WorkPose) {
        let mut attachments = Arc::clone(&self.content.attachments);
        for (name, former) in &*work.before.attachments {
            let is_same = |own: &pliant_deform::Attachment| own.rests_as(former) && own != former;
            if attachments.get(name).is_some_and(is_same) {
                Arc::make_mut(&mut attachments).insert(*name, former.clone());
            }
        }
        if !Arc::ptr_eq(&attachments, &self.content.attachments) {
            self.set_attachments(attachments);
        }
    }

    pub(in crate::document) fn swap_work_pose(&mut self, work: &mut Option<Arc<WorkPose>>) {
        std::mem::swap(work, &mut self.content.work_pose);
    }
}

/// Puts a handle back to where it was.
fn restore(handle: &mut Handle, former: &Handle) {
    let stance = Placed::of(former).about(handle.pivot);
    (handle.transform, handle.turn_deg) = (stance.transform, stance.turn_deg);
    if handle.line_binds_as(former) {
        handle.line.clone_from(&former.line);
    }
}

fn sum(a: &[DVec3], b: &[DVec3]) -> Vec<DVec3> {
    // Vertices without a correction keep every bit.
    let sum = |(a, b): (&DVec3, &DVec3)| if *b == DVec3::ZERO { *a } else { *a + *b };
    a.iter().zip(b).map(sum).collect()
}
