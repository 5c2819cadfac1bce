//! Where one looked from before: the camera has a way back and forth of its own, apart from the document's undo.
//!
//! A place counts once the camera has left it: a gesture of the pointer is one way, however many events it has.

use super::camera::Camera;

/// How many places are kept.
const MOST: usize = 64;

/// Places behind and ahead of the present one.
#[derive(Debug, Default)]
pub(crate) struct CameraHistory {
    behind: Vec<Camera>,
    ahead: Vec<Camera>,
    /// Where the camera stood when it last came to rest.
    resting: Option<Camera>,
}

/// Which way.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum CameraStep {
    Back,
    Forth,
}

impl CameraHistory {
    /// Takes note of where the camera rests.
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

    /// Where a step leads from `camera`; `None` where there is no such place.
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

    /// Whether there is a place that way.
    pub(crate) fn has(&self, step: CameraStep) -> bool {
        match step {
            CameraStep::Back => !self.behind.is_empty(),
            CameraStep::Forth => !self.ahead.is_empty(),
        }
    }
}
