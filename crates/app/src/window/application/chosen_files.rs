//! Dialogs that ask for a file: the paths that they begin with, and the paths that are chosen.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pliant_engine::is_project;

use crate::window::application::Application;
use crate::window::dialogs::file_dialog;
use crate::window::dialogs::question::Question;
use crate::window::files::listing;
use crate::window::files::save_request::Content;
use crate::window::threads::message::{Message, Purpose};

impl Application {
    /// Asks for a file by the system's dialog.
    pub(in crate::window) fn choose(&self, purpose: Purpose) {
        file_dialog::choose(purpose, &self.suggested_path(purpose), &self.workers);
    }

    /// Asks for a file to open by the window's own dialog, as on systems without one.
    pub fn browse_to_open(&mut self) {
        self.browse(Purpose::Open, &self.suggested_path(Purpose::Open));
    }

    /// The same for the name to save the model under.
    pub fn browse_to_save(&mut self) {
        self.browse(Purpose::SaveAs, &self.suggested_path(Purpose::SaveAs));
    }

    /// Asks for a file by the window's own dialog, which begins at `suggested`.
    pub(in crate::window) fn browse(&mut self, purpose: Purpose, suggested: &Path) {
        let browser = file_dialog::browser(purpose, suggested, self.path(), &self.settings.get().recent);
        self.dialogs.question = Some(Question::File(purpose, Box::new(browser)));
        self.read_folder();
    }

    /// Reads the folder that the window's own dialog wants to show, off the window's thread.
    pub(in crate::window) fn read_folder(&mut self) {
        let Some(Question::File(_, browser)) = &mut self.dialogs.question else {
            return;
        };
        if let Some(folder) = browser.take_wanted() {
            let unread = folder.clone();
            self.workers.spawn(
                "folder",
                move || {
                    let contents = listing::read(&folder);
                    Message::Folder(folder, contents)
                },
                move |sentence| Message::Folder(unread.clone(), Err(sentence)),
            );
        }
    }

    pub(in crate::window) fn suggested_path(&self, purpose: Purpose) -> PathBuf {
        let beside = |path: &Path, ending: &str| path.with_extension(ending);
        match (purpose, self.path()) {
            (
                Purpose::Open
                | Purpose::OpenSequence
                | Purpose::Mix
                | Purpose::ApplyEdit
                | Purpose::Append
                | Purpose::LoadCage
                | Purpose::AddExample
                | Purpose::SaveAs,
                path,
            ) => path.unwrap_or(Path::new("edited.glb")).to_owned(),
            (Purpose::SaveMorph, Some(path)) => beside(path, "morph.glb"),
            (Purpose::ExportEdit, Some(path)) => beside(path, "edit.json"),
            (Purpose::ExportFrames, _) => self.suggested_frames().unwrap_or_else(|| PathBuf::from("sequence")),
            (Purpose::ExportAnimation, Some(path)) => beside(path, "animation.glb"),
            (Purpose::ExportFlow, Some(path)) => beside(path, "flow.glb"),
            (Purpose::SaveProject, Some(path)) => beside(path, "pliant"),
            (Purpose::SavePicture(_), Some(path)) => beside(path, "png"),
            (Purpose::SaveMorph, None) => PathBuf::from("morph.glb"),
            (Purpose::SaveProject, None) => PathBuf::from("edited.pliant"),
            (Purpose::ExportAnimation, None) => PathBuf::from("animation.glb"),
            (Purpose::ExportFlow, None) => PathBuf::from("flow.glb"),
            (Purpose::ExportEdit, None) => PathBuf::from("edit.json"),
            (Purpose::SavePicture(_), None) => PathBuf::from("picture.png"),
        }
    }

    /// The name under which the frames of the open sequence are exported, beside it.
    fn suggested_frames(&self) -> Option<PathBuf> {
        let sequence = self.session.open.as_ref()?.sequence.as_ref()?.path();
        let mut name = sequence.file_stem()?.to_owned();
        name.push("-edited");
        Some(match sequence.extension().filter(|_| sequence.is_file()) {
            Some(ending) => sequence.with_file_name(name).with_extension(ending),
            None => sequence.with_file_name(name),
        })
    }

    pub(in crate::window) fn chosen(&mut self, purpose: Purpose, path: Option<PathBuf>) {
        match (purpose, path) {
            (Purpose::Open, Some(path)) => self.open(path),
            (Purpose::OpenSequence, Some(path)) => self.open_sequence(path),
            (Purpose::Mix, Some(path)) => self.mix_with(&path),
            (Purpose::ApplyEdit, Some(path)) => self.ask_to_open(path),
            (Purpose::SaveAs, Some(path)) if is_project(&path) => self.save_project_to(path),
            (Purpose::SaveAs, Some(path)) => self.save_as(path),
            (Purpose::SaveMorph, Some(path)) => self.save_morph_to(path),
            (Purpose::SaveProject, Some(path)) => self.save_project_to(path),
            (Purpose::ExportEdit, Some(path)) => self.export_edit(&path),
            (Purpose::Append, Some(path)) => self.append(path),
            (Purpose::ExportAnimation, Some(path)) => self.export_animation(&path),
            (Purpose::ExportFrames, Some(path)) => self.export_frames(&path),
            (Purpose::ExportFlow, Some(path)) => self.export_flow(&path),
            (Purpose::LoadCage, Some(path)) => self.load_cage(path),
            (Purpose::AddExample, Some(path)) => self.load_example(path),
            (Purpose::SavePicture(kind), Some(path)) => match self.viewport.picture(&self.editor, kind) {
                Ok(Some(image)) => self.save_copy(&path, Content::Picture(Arc::new(image))),
                Ok(None) => self.fail("the view is busy or empty: try again".to_owned()),
                Err(error) => self.fail(error.to_string()),
            },
            // The action that was to follow the save is given up with it.
            (_, None) => self.waiting.then = None,
        }
    }
}
