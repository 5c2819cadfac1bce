//! Actions on the bent path of a sequence's body.

use glam::DVec3;

use super::body_way::BodyWay;
use super::state::Workspace;
use crate::document::Animation;
use crate::ground_axis::GroundAxis;
use crate::timeline::{BodyMotion, FollowedFrame, Following};
use crate::view::{Look, UpAxis};

/// The name of the steps that move the path.
pub(crate) const BEND_PATH: &str = "Bend path";

/// Moves the body at a frame, by a way in world units, in one step.
pub(crate) fn bend_path(workspace: &mut Workspace, frame: usize, shift: DVec3, up: UpAxis) {
    workspace.step(BEND_PATH, |workspace| put_path(workspace, frame, shift, up));
}

/// Moves the body at a frame, by a way in world units, in the present step.
pub(crate) fn put_path(workspace: &mut Workspace, frame: usize, shift: DVec3, up: UpAxis) {
    let animation = workspace.document.animation();
    let animation = animation.bend_path(frame, shift, ground_axis(up));
    put(workspace, animation);
}

/// No longer moves the body at a frame.
pub(crate) fn free_path(workspace: &mut Workspace, frame: usize) {
    workspace.step("Remove path point", |workspace| {
        let animation = workspace.document.animation().free_path(frame);
        put(workspace, animation);
    });
}

/// Gives the document another path. Footprints rest on it.
fn put(workspace: &mut Workspace, animation: Animation) {
    let has_footprints = !animation.footprints().is_empty();
    workspace.document.set_animation(animation);
    if has_footprints {
        workspace.pose_frame();
    }
}

fn ground_axis(up: UpAxis) -> GroundAxis {
    match up {
        UpAxis::Y => GroundAxis::Y,
        UpAxis::Z => GroundAxis::Z,
    }
}

impl Workspace {
    /// The way of the open sequence's body.
    pub(crate) fn body_way(&self) -> &BodyWay {
        &self.frames.way
    }

    /// The upright direction of the path, or of a new one if `up` points up in the view.
    pub(crate) fn path_up(&self, up: UpAxis) -> DVec3 {
        let path = self.document.animation().path();
        path.map_or(ground_axis(up), |path| path.up()).direction()
    }

    /// The motion of the body in the shown frame; `None` until it is known.
    pub(crate) fn body_motion(&self) -> Option<BodyMotion> {
        let animation = self.document.animation();
        match animation.path() {
            Some(_) if animation.frames().is_some() => self.frames.way.motion(animation.frame()),
            _ => Some(BodyMotion::STILL),
        }
    }

    /// Returns true if all frames must be read: the path is shown or bent, and the body's way is not known, or ways are
    /// filtered, and those of the handles are not known.
    pub(crate) fn wants_following(&self, look: &Look) -> bool {
        let animation = self.document.animation();
        let has_path = (look.timeline && look.path) || animation.path().is_some();
        let is_needed = (has_path && self.frames.way.is_unknown()) || self.awaits_handles();
        animation.frames().is_some() && is_needed && !self.frames.has_failed
    }

    /// Takes all frames that were read, in which these handles were followed, or the reason why they can't be.
    pub(crate) fn take_followed(&mut self, following: &Following, frames: Result<Vec<FollowedFrame>, String>) {
        match (frames, self.model().cloned()) {
            (Ok(frames), Some(model)) if Some(frames.len()) == self.document.animation().frames() => {
                self.frames.way.take(&frames, &model);
                self.frames.ways.take(following, &frames);
            }
            (Ok(_), _) => {}
            (Err(sentence), _) => {
                self.frames.has_failed = true;
                self.refuse(sentence);
            }
        }
    }

    /// Reads the frames again if they could not be read.
    pub(crate) fn try_to_follow_again(&mut self) {
        self.frames.has_failed = false;
    }

    /// Computes the body's motions by the document's present path.
    pub(crate) fn follow_path(&mut self) {
        self.frames.way.follow(self.document.animation().path());
    }
}
