//! Unsaved work: the question before it would be lost, and its copy for the next session.

use std::path::PathBuf;

use eframe::egui;

use crate::files::names::file_name;
use crate::window::application::Application;
use crate::window::dialogs::question::{Question, Then};
use crate::window::files::recovery::left::remove;
use crate::window::session::Source;
use crate::window::threads::message::{Message, Purpose};

impl Application {
    /// Opens a file, after a question if unsaved work would be lost.
    pub fn ask_to_open(&mut self, path: PathBuf) {
        self.unless_unsaved(Then::Open(Some(path)));
    }

    /// Goes on at once after the running saves, or when the person has agreed to lose unsaved work.
    pub(super) fn unless_unsaved(&mut self, then: Then) {
        if self.is_saving() {
            self.waiting.then = Some(then);
        } else if self.editor.view().unsaved {
            self.dialogs.question = Some(self.about_unsaved(then));
        } else {
            self.go_on(then);
        }
    }

    /// Asks about unsaved work, naming the file that lacks it.
    pub(in crate::window) fn about_unsaved(&self, then: Then) -> Question {
        let open = self.session.open.as_ref();
        let name = self.project().as_deref().map(file_name);
        let name = name.or_else(|| open.map(|open| open.name()));
        Question::Discard(then, name.unwrap_or_default())
    }

    pub(in crate::window) fn go_on(&mut self, then: Then) {
        match then {
            Then::Open(Some(path)) => self.open(path),
            Then::Open(None) => self.choose(Purpose::Open),
            Then::OpenSequence => self.choose(Purpose::OpenSequence),
            Then::Sample => self.session.load(Source::Sample, &self.viewport.gpu(), &self.workers),
            Then::Close => self.closing = true,
        }
    }

    /// Lets the window close unless there is unsaved work that nobody agreed to lose.
    pub(in crate::window) fn close_or_stay(&mut self, context: &egui::Context) {
        let has_more_to_do = || self.editor.view().unsaved || self.is_saving();
        if self.closing {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        } else if context.input(|input| input.viewport().close_requested()) && has_more_to_do() {
            context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            // The question comes in the next frame, without waiting for the pointer to move.
            self.unless_unsaved(Then::Close);
            context.request_repaint();
        }
    }

    /// Writes unsaved work where the next session finds it.
    pub(super) fn keep_for_recovery(&mut self) {
        let (Some(recovery), Some(open)) = (&mut self.recovery, &self.session.open) else {
            return;
        };
        let (key, unsaved) = (self.editor.snapshot_key(), self.editor.view().unsaved);
        let Some(work) = recovery.note(
            key,
            unsaved,
            || self.editor.snapshot(),
            &open.mesh,
            [open.path.as_deref(), open.project.as_deref()],
        ) else {
            // This session now keeps or has saved the recovered work.
            if recovery.has(key) || !unsaved {
                self.recovered_from.take().iter().for_each(|left| remove(left));
            }
            return;
        };
        self.workers.spawn(
            "autosave",
            move || Message::Autosaved(key, work.write()),
            move |sentence| Message::Autosaved(key, Err(sentence)),
        );
    }
}
