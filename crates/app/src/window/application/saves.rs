//! Saves that a person requests: they wait until the shape has settled, ask if another program has changed the file,
//! and are followed by the next requested action.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pliant_editor::{Command, Event, Revision, SavedAs};

use crate::files::names::{file_name, free_name};
use crate::window::application::Application;
use crate::window::dialogs::file_dialog;
use crate::window::dialogs::question::{ChangedOffer, Question};
use crate::window::files::save_request::{Changed, Content, Model, Shape, Unwritten, Written, WrittenKind};
use crate::window::files::save_wish::SaveWish;
use crate::window::panels::notes::Note;
use crate::window::session::KeepOriginal;
use crate::window::threads::message::{Ground, PictureKind, Purpose};
use pliant_engine::files::shown;
use pliant_engine::is_project;

impl Application {
    /// Saves under `path` once the shape has settled, without asking whether it may replace a source.
    pub fn save_to(&mut self, path: PathBuf, keep_original: KeepOriginal) {
        self.wish(SaveWish::Model(path, keep_original));
    }

    /// Saves a copy whose mesh rests, with the present shape as a morph target of weight 1, under `path`.
    pub fn save_morph_to(&mut self, path: PathBuf) {
        self.wish(SaveWish::Morph(path));
    }

    /// Saves the project under `path`, which gets its extension if it has none.
    pub fn save_project_to(&mut self, path: PathBuf) {
        self.wish(SaveWish::Project(project_path(path)));
    }

    fn wish(&mut self, wish: SaveWish) {
        // A failure before this is over.
        self.notes.headline = None;
        // A stretch of play that has not ended is in no file.
        self.editor.handle(Event::Command(Command::PauseFlow));
        if self.editor.view().is_animating {
            self.editor.handle(Event::Command(Command::PlayKeys));
        }
        let (same, others) = std::mem::take(&mut self.waiting.wishes)
            .into_iter()
            .partition(|other| other.path() == wish.path());
        self.waiting.wishes = others;
        self.waiting.wishes.push(wish.in_place_of(same));
        self.save_what_has_settled();
        if let Some(waiting) = self.waiting_save() {
            self.notes.headline = Some(Note::Done(format!("{waiting}.")));
        }
    }

    /// Saves over the opened file, as the person has agreed: there is no further question while that waits.
    pub(in crate::window) fn write_over(&mut self, path: PathBuf) {
        if let Some(open) = &mut self.session.open {
            open.may_write_over = true;
        }
        self.save_to(path, KeepOriginal::Yes);
    }

    /// Begins the waiting saves, once no other shape can follow.
    pub(in crate::window) fn save_what_has_settled(&mut self) {
        if !self.waiting.wishes.is_empty() && self.editor.is_settled() {
            self.save_as_it_is();
        }
    }

    /// Begins the waiting saves, with the present shape.
    pub fn save_as_it_is(&mut self) {
        let wishes = std::mem::take(&mut self.waiting.wishes);
        let Some(open) = &self.session.open else { return };
        let mesh = open.mesh.clone();
        let mark = self.editor.save_mark();
        for wish in wishes {
            let (path, content) = match wish {
                SaveWish::Model(path, keep_original) => {
                    let (mesh, shape) = (mesh.clone(), self.shape());
                    let model = Model {
                        mesh,
                        shape,
                        keep_original,
                    };
                    (path, Content::Model(model))
                }
                SaveWish::Morph(path) => (path, Content::Morph(self.shape(), mesh.clone())),
                SaveWish::Project(path) => match self.editor.snapshot() {
                    Some(snapshot) => (path, Content::Project(Box::new(snapshot), mesh.clone())),
                    None => continue,
                },
            };
            self.session.save(&path, content, mark, &self.workers);
        }
    }

    pub(super) fn shape(&self) -> Shape {
        Shape {
            displacements: self.editor.lasting_shape(),
            inside_out: Arc::clone(self.editor.document().inside_out()),
            dye: self.editor.document().fluid().kept.clone(),
        }
    }

    /// The waiting saves and their reason, in a sentence; `None` if none waits.
    pub fn waiting_save(&self) -> Option<String> {
        let names: Vec<String> = self.waiting.wishes.iter().map(|wish| file_name(wish.path())).collect();
        let verb = if names.len() > 1 { "are" } else { "is" };
        let end = match self.editor.is_acting() {
            true => "the current action has ended and the shape has settled",
            false => "the shape has settled",
        };
        (!names.is_empty()).then(|| format!("{} {verb} saved once {end}", names.join(" and ")))
    }

    /// Gives up the waiting saves, and stops the running work on files.
    pub(in crate::window) fn stop_file_work(&mut self) {
        self.waiting.wishes.clear();
        self.waiting.then = None;
        self.session.stop();
        self.session.ask_again();
    }

    /// Returns true if a save is under way or waits.
    pub(in crate::window) fn is_saving(&self) -> bool {
        self.session.is_saving() || !self.waiting.wishes.is_empty()
    }

    /// Saves the open project, or else the model.
    pub(in crate::window) fn save_what_is_open(&mut self) {
        match self.project() {
            Some(project) => self.save_project_to(project),
            None if self.is_sequence() => self.choose(Purpose::SaveProject),
            None => self.save(),
        }
    }

    /// Returns true if a sequence is open, whose frames are never saved over.
    pub(in crate::window) fn is_sequence(&self) -> bool {
        self.session.open.as_ref().is_some_and(|open| open.sequence.is_some())
    }

    fn may_write_over(&self) -> bool {
        self.session.open.as_ref().is_some_and(|open| open.may_write_over)
    }

    /// Saves the model in its place, after asking whether the opened file may be replaced.
    pub(in crate::window) fn save(&mut self) {
        match self.path().map(Path::to_owned) {
            Some(path) if self.may_write_over() => self.save_to(path, KeepOriginal::No),
            Some(path) => {
                self.session.look_for_original(&path, &self.workers);
                self.dialogs.question = Some(Question::WriteOver(path, None));
            }
            None => self.choose(Purpose::SaveAs),
        }
    }

    /// Saves the model under a path that was chosen in a dialog.
    pub(in crate::window) fn save_as(&mut self, path: PathBuf) {
        let is_source = self.session.open.as_ref().is_some_and(|open| open.is_at(&path));
        let keep_original = match is_source && !self.may_write_over() {
            true => KeepOriginal::Yes,
            false => KeepOriginal::No,
        };
        self.save_to(path, keep_original);
    }

    /// Takes a save's end.
    pub(in crate::window) fn written(&mut self, stamp: Revision, result: Result<Written, Unwritten>) {
        self.session.written(stamp, &result, &self.workers);
        match result {
            Ok(written) => self.was_written(&written),
            Err(Unwritten::Changed(path, request)) => {
                self.session.ask_again();
                let offers = match self.reload(&request.content) {
                    Some((_, lost)) => ChangedOffer::Reload { lost },
                    None => ChangedOffer::Others,
                };
                self.dialogs.question = Some(Question::Changed(path, offers));
                self.waiting.unwritten = Some(request);
            }
            Err(Unwritten::FramesExist { first, count, request }) => {
                self.dialogs.question = Some(Question::ReplaceFrames { first, count });
                self.waiting.unwritten = Some(request);
            }
            Err(Unwritten::Refused(sentence)) => {
                self.session.ask_again();
                self.waiting.then = None;
                self.fail(sentence);
            }
        }
    }

    fn was_written(&mut self, written: &Written) {
        let saved = match written.what {
            WrittenKind::Model { .. } => Some(SavedAs::Model),
            WrittenKind::Project => Some(SavedAs::Project),
            WrittenKind::Picture
            | WrittenKind::Edit
            | WrittenKind::Morph
            | WrittenKind::Animation
            | WrittenKind::Frames => None,
        };
        if let Some(saved) = saved {
            self.settings.change(|settings| settings.remember(&written.path));
            self.recent_pictures.want(&written.path);
            if self.session.is_of_open(written) {
                self.editor.handle(Event::Saved(saved, written.mark));
            }
            if self.editor.document().is_displaced() || self.editor.document().is_applied() {
                // This is the last of the first steps.
                self.settings.change(|settings| settings.hints_seen = true);
            }
        }
        let mut sentence = format!("Saved {}.", shown(&written.path));
        for note in &written.notes {
            sentence.push(' ');
            sentence.push_str(note);
        }
        self.notes.headline = Some(Note::Saved(sentence, written.path.clone()));
        self.go_on_after_saving();
    }

    /// Performs the action that was to follow the saves, once all of them have ended and nothing is unsaved.
    fn go_on_after_saving(&mut self) {
        if self.is_saving() || self.dialogs.question.is_some() {
            return;
        }
        match self.waiting.then.take() {
            Some(then) if self.editor.view().unsaved => self.dialogs.question = Some(self.about_unsaved(then)),
            Some(then) => self.go_on(then),
            None => {}
        }
    }

    /// Replaces the file that another program has changed.
    pub(in crate::window) fn overwrite(&mut self) {
        let Some(mut request) = self.waiting.unwritten.take() else {
            return;
        };
        request.changed = Changed::Replace;
        if let Content::Model(model) = &mut request.content {
            // The other program's work stays beside it.
            model.keep_original = KeepOriginal::Yes;
        }
        self.session.save_again(*request, &self.workers);
    }

    /// Asks for another name than that of the file that another program has changed.
    pub(in crate::window) fn save_beside(&mut self) {
        let Some(request) = self.waiting.unwritten.take() else {
            return;
        };
        file_dialog::choose(purpose(&request.content), &free_name(&request.path), &self.workers);
    }

    /// Writes an animation whose numbered files replace others.
    pub(in crate::window) fn replace_frames(&mut self) {
        let Some(mut request) = self.waiting.unwritten.take() else {
            return;
        };
        request.content.replace_frames();
        self.session.save_again(*request, &self.workers);
    }

    pub(super) fn project(&self) -> Option<PathBuf> {
        self.session.open.as_ref()?.project.clone()
    }
}

/// The purpose for which the path of such a file is chosen.
fn purpose(content: &Content) -> Purpose {
    match content {
        Content::Model(_) => Purpose::SaveAs,
        Content::Morph(..) => Purpose::SaveMorph,
        Content::Project(..) => Purpose::SaveProject,
        Content::Edit(..) => Purpose::ExportEdit,
        Content::Animation(_) => Purpose::ExportAnimation,
        Content::Frames(_) => Purpose::ExportFrames,
        Content::Flow(_) => Purpose::ExportFlow,
        Content::Picture(_) => Purpose::SavePicture(PictureKind {
            scale: 1,
            ground: Ground::AsShown,
        }),
    }
}

/// A project's path, with its extension.
pub(in crate::window) fn project_path(path: PathBuf) -> PathBuf {
    if is_project(&path) {
        return path;
    }
    let mut name = path.into_os_string();
    name.push(".pliant");
    PathBuf::from(name)
}
