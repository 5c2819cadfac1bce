//! Copies of the unsaved work: an edit, a picture, an animation, the frames of a sequence or of a flow.

use std::path::Path;
use std::sync::Arc;

use pliant_engine::flow::flow_frames_path;
use pliant_engine::watch::Watch;
use pliant_engine::{ExistingFrames, animation_path};

use crate::window::application::Application;
use crate::window::files::save_request::{AnimationToWrite, Content, FlowToWrite, FramesToWrite};

impl Application {
    /// Writes the edit, with the places by which other meshes find its parts, under `path`.
    pub fn export_edit(&mut self, path: &Path) {
        match (self.editor.edit_file(), self.editor.view().model) {
            (Ok(edit), Some(model)) => {
                let model = Arc::clone(model);
                self.save_copy(path, Content::Edit(Box::new(edit), model));
            }
            (Err(error), _) => self.fail(error.to_string()),
            (Ok(_), None) => {}
        }
    }

    /// Writes the document's unsaved changes.
    pub(super) fn save_copy(&mut self, path: &Path, content: Content) {
        // A failure before this is over.
        self.notes.headline = None;
        let mark = self.editor.save_mark();
        self.session.save(path, content, mark, &self.workers);
    }

    /// Writes the edit over time, off the window's thread: a file for each frame if the format has one shape in a file.
    pub fn export_animation(&mut self, path: &Path) {
        let path = &animation_path(path);
        let Some(open) = &self.session.open else { return };
        let mesh = open.mesh.clone();
        match self.editor.edit_file() {
            Ok(edit) => {
                let animation = AnimationToWrite {
                    edit,
                    fps: self.editor.document().animation().fps(),
                    frames: ExistingFrames::Keep,
                    mesh,
                    dye: self.editor.document().fluid().kept.clone(),
                    watch: Watch::default(),
                };
                self.save_copy(path, Content::Animation(Box::new(animation)));
            }
            Err(error) => self.fail(error.to_string()),
        }
    }

    /// Writes a file for each frame of the flow that was played, in the present shape, off the window's thread.
    pub fn export_flow(&mut self, path: &Path) {
        let Some(open) = &self.session.open else { return };
        let Some(recording) = self.editor.flow_recording().cloned() else {
            return;
        };
        let flow = FlowToWrite {
            recording,
            shape: self.shape(),
            mesh: open.mesh.clone(),
            fps: self.editor.document().animation().fps(),
            frames: ExistingFrames::Keep,
            watch: Watch::default(),
        };
        self.save_copy(&flow_frames_path(path), Content::Flow(Box::new(flow)));
    }

    /// Writes all frames of the open sequence with the edit, off the window's thread.
    pub fn export_frames(&mut self, path: &Path) {
        let Some(open) = &self.session.open else { return };
        let Some(sequence) = &open.sequence else { return };
        let (place, mesh) = (sequence.path().to_owned(), open.loaded.path.clone());
        match self.editor.edit_file() {
            Ok(edit) => {
                let frames = FramesToWrite {
                    edit,
                    cached_mesh: sequence.is_cache().then_some(mesh),
                    sequence: place,
                    fps: sequence.fps(),
                    existing: ExistingFrames::Keep,
                    watch: Watch::default(),
                };
                self.save_copy(path, Content::Frames(Box::new(frames)));
            }
            Err(error) => self.fail(error.to_string()),
        }
    }
}
