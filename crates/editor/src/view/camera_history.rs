//! Where one looked from before: the camera has a way back and forth of its own, apart from the document's undo.
//!
//! A place counts once the camera has left it: a gesture of the pointer is one way, however many events it has.

use crate::Camera;
use crate::editor::Editor;
use crate::tool::Tool;

/// How many places are kept.
const MOST: usize = 64;

/// Places behind and ahead of the present one.
#[derive(Debug, Default)]
pub(crate) struct CameraHistory {
    pub(crate) behind: Vec<Camera>,
    pub(crate) ahead: Vec<Camera>,
    /// Where the camera stood when it last came to rest.
    resting: Option<Camera>,
}

/// Which way.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum CameraStep {
    Back,
    Forth,
}

impl Editor {
    /// Takes note of the camera when no gesture moves it.
    pub(crate) fn note_camera(&mut self) {
        if matches!(self.tool, Tool::Navigate(_)) {
            return;
        }
        let history = &mut self.camera_history;
        let Some(resting) = history.resting.replace(self.camera) else {
            return;
        };
        if resting != self.camera {
            history.ahead.clear();
            history.behind.push(resting);
            if history.behind.len() > MOST {
                history.behind.remove(0);
            }
        }
    }

    pub(crate) fn camera_step(&mut self, step: CameraStep) {
        let history = &mut self.camera_history;
        let (from, to) = match step {
            CameraStep::Back => (&mut history.behind, &mut history.ahead),
            CameraStep::Forth => (&mut history.ahead, &mut history.behind),
        };
        if let Some(camera) = from.pop() {
            to.push(self.camera);
            self.camera = camera;
            history.resting = Some(camera);
            self.is_framed = false;
        }
    }
}
