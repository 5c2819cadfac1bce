//! The open file read again: after another program has changed it, or with another welding.

use pliant_mesh::WeldOptions;

use crate::window::application::Application;
use crate::window::files::in_file::InFile;
use crate::window::files::rest_mesh::MeshSource;
use crate::window::files::save_request::Content;
use crate::window::session::Source;
use crate::window::session::opening::Reload;

impl Application {
    /// Opens the changed file with the former one's edit.
    pub(in crate::window) fn reload_changed(&mut self) {
        let reload = self
            .waiting
            .unwritten
            .take()
            .and_then(|request| self.reload(&request.content));
        if let Some((reload, _)) = reload {
            self.waiting.then = None;
            let source = Source::Reloaded(Box::new(reload));
            self.session.load(source, &self.viewport.gpu(), &self.workers);
        }
    }

    /// The way to open the changed file again with the former one's edit, if it is known which part of the edit the
    /// file has, and the names of the changes of its triangles that no file has, which are then lost.
    pub(super) fn reload(&self, content: &Content) -> Option<(Reload, Vec<&'static str>)> {
        let open = self.session.open.as_ref()?;
        let file = open.path.clone()?;
        let is_model = matches!(content, Content::Model(_));
        let mut snapshot = self.editor.snapshot().filter(|_| is_model)?;
        let mut lost = Vec::new();
        let mut in_file = &open.in_file;
        while let InFile::Made(name, former) = in_file {
            lost.insert(0, *name);
            snapshot = former.restore(&snapshot)?;
            in_file = self.session.others.in_file(snapshot.model())?;
        }
        let saved = match in_file {
            InFile::AsRead => None,
            InFile::Saved(saved) => Some(saved.clone()),
            InFile::Made(..) | InFile::Unknown => return None,
        };
        let reload = Reload {
            // As before: the edit or a person may have requested it.
            weld: snapshot.model().weld,
            snapshot,
            saved,
            project: open.project.clone(),
            path: Some(file.clone()),
            file: Some(file),
            unsaved: true,
        };
        Some((reload, lost))
    }

    /// Opens the mesh again with its vertices welded in another way, and applies the work to it. It is read from its
    /// original place, or else from the saved file.
    pub(in crate::window) fn weld_anew(&mut self, weld: WeldOptions) {
        let (Some(open), Some(snapshot)) = (&self.session.open, self.editor.snapshot()) else {
            return;
        };
        if snapshot.model().weld == weld {
            return;
        }
        if self.is_sequence() {
            return self.fail(
                "the vertices of a sequence are welded as it was opened: weld those of a single file".to_owned(),
            );
        }
        let (file, saved) = match &open.mesh.source {
            MeshSource::Sample => (None, None),
            MeshSource::File(file) => (Some(file.clone()), None),
            MeshSource::Gone => match open.in_file.saved() {
                Some(saved) => (open.path.clone(), Some(saved.clone())),
                None => {
                    let gone =
                        "no file holds the mesh as it was opened: save the project, open it, then weld its vertices";
                    return self.fail(gone.to_owned());
                }
            },
        };
        let reload = Reload {
            file,
            path: open.path.clone(),
            weld,
            snapshot,
            saved,
            project: open.project.clone(),
            // A project keeps the distance, too.
            unsaved: self.editor.view().unsaved || open.project.is_some(),
        };
        let source = Source::Reloaded(Box::new(reload));
        self.session.load(source, &self.viewport.gpu(), &self.workers);
    }
}
