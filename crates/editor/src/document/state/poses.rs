//! The kept poses, by their names.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::Document;
use crate::document::handle::HandleId;
use crate::document::pose::{Placed, Pose};
use crate::document::strength::Stance;

impl Document {
    /// The kept poses, in the order in which they were kept.
    pub fn poses(&self) -> &[Pose] {
        &self.content.poses
    }

    /// Returns true if handles, control points and weights show this pose.
    pub fn is_in_pose(&self, pose: &Pose) -> bool {
        let mut handles = self.content.handles.iter();
        handles.all(|handle| {
            let placed = pose.handles.get(&handle.id);
            placed.is_none_or(|placed| self.stance_in(placed, handle.pivot).transform == handle.transform)
        }) && pose.attachments(&self.content.attachments) == self.content.attachments
    }

    /// The stance of a pose's handle that has this pivot now. In another frame of a sequence the handle is elsewhere, and
    /// the pose moves it as much from there.
    fn stance_in(&self, placed: &Placed, pivot: DVec3) -> Stance {
        match self.content.animation.frames() {
            Some(_) => placed.stance,
            None => placed.about(pivot),
        }
    }

    /// The shown state, as a pose.
    pub(crate) fn present_pose(&self, name: String) -> Pose {
        let content = &self.content;
        Pose::of(name, &content.handles, &content.method, &content.attachments)
    }

    /// Changes the list of poses.
    pub(crate) fn change_poses(&mut self, change: impl FnOnce(&mut Vec<Pose>)) {
        change(Arc::make_mut(&mut self.content.poses));
    }

    /// Moves the handles that `may_move` to a pose, along with control points and weights; the shape must then be
    /// solved.
    pub(crate) fn take_pose(&mut self, pose: &Pose, may_move: impl Fn(HandleId) -> bool) {
        if self.is_in_pose(pose) {
            return;
        }
        self.unsettle();
        let attachments = pose.attachments(&self.content.attachments);
        if attachments != self.content.attachments {
            self.set_attachments(attachments);
        }
        let own = self.content.handles.iter().filter(|handle| may_move(handle.id));
        let stances = own.filter_map(|handle| {
            let placed = pose.handles.get(&handle.id)?;
            Some((handle.id, self.stance_in(placed, handle.pivot)))
        });
        let stances: BTreeMap<HandleId, Stance> = stances.collect();
        self.change_handles(|handles| {
            for handle in handles {
                if let Some(stance) = stances.get(&handle.id) {
                    (handle.transform, handle.turn_deg) = (stance.transform, stance.turn_deg);
                }
            }
        });
    }

    pub(in crate::document) fn swap_poses(&mut self, poses: &mut Arc<Vec<Pose>>) {
        std::mem::swap(poses, &mut self.content.poses);
    }
}
