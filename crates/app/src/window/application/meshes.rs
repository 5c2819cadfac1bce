//! The open file's triangles, which commands, undo and redo change.

use std::path::PathBuf;
use std::sync::Arc;

use pliant_editor::{Command, Event, MeshChange, Revision};

use crate::window::application::Application;
use crate::window::input::file_command::FileCommand;
use crate::window::panels::notes::Note;
use crate::window::threads::message::{Refusal, Stitched};
use crate::window::viewport::shown::Shown;

impl Application {
    /// Puts another file beside the present shape, off the window's thread.
    pub fn append(&mut self, path: PathBuf) {
        if let Some(why) = FileCommand::Append.unavailable_because(&self.editor) {
            return self.fail(why.to_owned());
        }
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        self.session.to_append = Some(path);
        self.command(Command::ChangeMesh(MeshChange::Append(name)));
    }

    /// Begins the change of the mesh that the editor has been asked for.
    pub(in crate::window) fn begin_stitching(&mut self) {
        if let Some(request) = self.editor.take_stitch() {
            self.session.stitch(request, &self.viewport.gpu(), &self.workers);
        }
    }

    /// Takes the end of a change of the mesh.
    pub(in crate::window) fn take_stitched(&mut self, stamp: Revision, result: Result<Box<Stitched>, Refusal>) {
        if !self.session.has_stitched(stamp) {
            return;
        }
        let result = result.map(|stitched| {
            let Stitched {
                mesh,
                shape,
                notes,
                left_open,
            } = *stitched;
            self.session.others.add(shape);
            (mesh, notes, left_open)
        });
        let before = self.editor.history().names().1;
        let is_appended = self.session.to_append.take().is_some();
        let (mesh, notes, left_open) = match result {
            Ok((mesh, notes, left_open)) => (Ok(Box::new(mesh)), notes, left_open),
            Err(Refusal { sentence, place }) => {
                if let Some(vertex) = place {
                    self.editor.handle(Event::Command(Command::FrameFileVertex(vertex)));
                }
                (Err(sentence), Vec::new(), Vec::new())
            }
        };
        self.editor.handle(Event::Stitched(mesh));
        let mut notes = notes.into_iter();
        if let Some(done) = notes.next().filter(|_| self.editor.history().names().1 > before) {
            self.notes.headline = Some(Note::Done(done));
            self.notes.about_file = notes.collect();
            self.notes.open_borders = left_open;
            if is_appended {
                self.editor.handle(Event::Command(Command::FrameAll));
            }
        }
        self.follow_mesh();
    }

    /// Shows the mesh that the editor has now, after a change of it was made, undone or redone.
    pub(in crate::window) fn follow_mesh(&mut self) {
        let (Some(open), Some(model)) = (&mut self.session.open, self.editor.view().model) else {
            return;
        };
        if Arc::ptr_eq(&open.loaded.model, model) {
            return;
        }
        let Some(kept) = self.session.others.open(model, open) else {
            return;
        };
        let (loaded, drawing) = (Arc::clone(&open.loaded), Arc::clone(&open.drawing));
        let history = self.editor.history();
        let leads_to = |model: &_| history.meshes().any(|mesh| Arc::ptr_eq(mesh, model));
        self.session.others.forget_unless(leads_to);
        self.redrawing = None;
        self.pose_from(&loaded, &drawing);
        let shown = match kept {
            Some(kept) => Ok(kept),
            None => {
                let displacements = Arc::clone(self.editor.view().drawn);
                let pose = drawing.pose(&loaded.model, &displacements);
                let surface = self.viewport.gpu().upload(&drawing, &pose);
                surface.map(|surface| Shown::new(drawing, surface, displacements, &loaded.model))
            }
        };
        match shown {
            Ok(shown) => self.session.others.keep(self.viewport.show(shown)),
            Err(error) => self.fail(error.to_string()),
        }
    }
}
