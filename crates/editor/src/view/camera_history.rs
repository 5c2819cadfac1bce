//! The camera's history: it has its own back and forth, apart from the document's undo.
//!
//! A place counts once the camera has left it: a gesture of the pointer is one movement, for any number of events.

use super::camera::Camera;

/// The number of kept places.
const MOST: usize = 64;

/// Places before and after the present one.
#[derive(Debug, Default)]
pub(crate) struct CameraHistory {
    behind: Vec<Camera>,
    ahead: Vec<Camera>,
    /// The camera's last resting place.
    resting: Option<Camera>,
}

/// The direction in the history.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum CameraStep {
    Back,
    Forth,
}

impl CameraHistory {
    /// Notes the camera's resting place.
    pub(super) fn rest(&mut self, camera: Camera) {
        let Some(resting) = self.resting.replace(camera) else {
            return;
        };
        if resting != camera {
            self.ahead.clear();
            self.behind.push(resting);
            if self.behind.len() > MOST {
                self.behind.remove(0);
            }
        }
    }

    /// The destination of a step from `camera`; `None` if there is none.
    pub(super) fn step(&mut self, step: CameraStep, camera: Camera) -> Option<Camera> {
        let (from, to) = match step {
            CameraStep::Back => (&mut self.behind, &mut self.ahead),
            CameraStep::Forth => (&mut self.ahead, &mut self.behind),
        };
        let next = from.pop()?;
        to.push(camera);
        self.resting = Some(next);
        Some(next)
    }

    /// Returns true if there is a place in that direction.
    pub(crate) fn has(&self, step: CameraStep) -> bool {
        match step {
            CameraStep::Back => !self.behind.is_empty(),
            CameraStep::Forth => !self.ahead.is_empty(),
        }
    }
}
