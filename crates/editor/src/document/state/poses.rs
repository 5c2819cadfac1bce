//! The poses that a person keeps by their names.

use std::sync::Arc;

use super::Document;
use crate::document::pose::Pose;

impl Document {
    /// The poses that are kept, in the order in which they were.
    pub fn poses(&self) -> &[Pose] {
        &self.content.poses
    }

    /// Whether a pose is what handles, control points and weights show.
    pub fn is_in_pose(&self, pose: &Pose) -> bool {
        let mut handles = self.content.handles.iter();
        handles.all(|handle| {
            let placed = pose.handles.get(&handle.id);
            placed.is_none_or(|placed| placed.about(handle.pivot).transform == handle.transform)
        }) && pose.attachments(&self.content.attachments) == self.content.attachments
    }

    /// What is shown, as a pose.
    pub(crate) fn present_pose(&self, name: String) -> Pose {
        let content = &self.content;
        Pose::of(name, &content.handles, &content.method, &content.attachments)
    }

    /// Changes the list of poses.
    pub(crate) fn change_poses(&mut self, change: impl FnOnce(&mut Vec<Pose>)) {
        change(Arc::make_mut(&mut self.content.poses));
    }

    /// Puts handles where a pose has them, those that `may_move`, to be solved for; and control points and weights.
    pub(crate) fn take_pose(&mut self, pose: &Pose, may_move: impl Fn(crate::document::HandleId) -> bool) {
        if self.is_in_pose(pose) {
            return;
        }
        self.unsettle();
        let attachments = pose.attachments(&self.content.attachments);
        if attachments != self.content.attachments {
            self.set_attachments(attachments);
        }
        self.change_handles(|handles| {
            for handle in handles.iter_mut().filter(|handle| may_move(handle.id)) {
                if let Some(placed) = pose.handles.get(&handle.id) {
                    let stance = placed.about(handle.pivot);
                    (handle.transform, handle.turn_deg) = (stance.transform, stance.turn_deg);
                }
            }
        });
    }

    pub(in crate::document) fn swap_poses(&mut self, poses: &mut Arc<Vec<Pose>>) {
        std::mem::swap(poses, &mut self.content.poses);
    }
}
