//! Files and sequences that are opened, and the frames of an open sequence.

use std::path::PathBuf;

use eframe::egui;
use pliant_editor::Event;

use crate::files::names::file_name;
use crate::window::application::Application;
use crate::window::files::rest_mesh::MeshSource;
use crate::window::session::{Source, meant_by};

impl Application {
    /// Opens a file without asking whether unsaved work may be lost.
    pub fn open(&mut self, path: PathBuf) {
        let is_edit = path
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
        let mesh = self.session.open.as_ref().map(|open| &open.mesh.source);
        let source = match (is_edit, mesh) {
            (false, mesh) => match (Source::file(path), mesh) {
                (Source::Sequence { path, chosen, .. }, Some(MeshSource::File(open))) => Source::Sequence {
                    path,
                    chosen,
                    open: Some(open.clone()),
                },
                (source, _) => source,
            },
            (true, Some(MeshSource::File(file))) => Source::Edited {
                file: file.clone(),
                edit: path,
                sequence: self.session.open.as_ref().and_then(|open| {
                    let sequence = open.sequence.as_ref()?;
                    Some(sequence.path().to_owned())
                }),
            },
            (true, _) => {
                return self.fail(format!(
                    "{} is an edit: open the mesh that it is for first.",
                    file_name(&path)
                ));
            }
        };
        self.session.load(source, &self.viewport.gpu(), &self.workers);
    }

    /// Opens the sequence that a person means by a file of it.
    pub fn open_sequence(&mut self, file: PathBuf) {
        let source = Source::Sequence {
            path: meant_by(&file),
            chosen: Some(file),
            open: self.session.open.as_ref().and_then(|open| match &open.mesh.source {
                MeshSource::File(open) => Some(open.clone()),
                _ => None,
            }),
        };
        self.session.load(source, &self.viewport.gpu(), &self.workers);
    }

    /// Gives the editor the frame of the sequence that it asks for, once it was read, and reads all frames if it must
    /// know the way of the body.
    pub(super) fn follow_frames(&mut self, context: &egui::Context) {
        if self.editor.view().wants_following && !self.session.is_following() {
            self.session.follow(self.editor.following(), &self.workers);
        }
        let wanted = self.editor.view().wanted_frame;
        if let Some((name, frame)) = self.editor.view().wanted_mix
            && let Some(shape) = self.session.mix_frame(name, frame, &self.workers)
        {
            let name = name.to_owned();
            self.editor.handle(Event::MixFrame(name, frame, Ok(shape)));
            context.request_repaint();
        }
        if let Some(frame) = wanted
            && let Some(shape) = self.session.frame(frame, &self.workers)
        {
            self.editor.handle(Event::Frame(frame, Ok(shape)));
            context.request_repaint();
        }
    }
}
