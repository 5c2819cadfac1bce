//! The answers to the window's questions.

use std::path::Path;

use crate::window::application::Application;
use crate::window::application::saves::project_path;
use crate::window::dialogs::file_dialog;
use crate::window::dialogs::question::{Answer, Question};
use crate::window::files::recovery::left;
use crate::window::session::Source;
use crate::window::threads::message::Purpose;

impl Application {
    pub(in crate::window) fn answer(&mut self, answer: Answer) {
        let question = self.dialogs.question.take();
        match answer {
            Answer::WriteOver(path) => self.write_over(path),
            Answer::SaveAs => self.choose(Purpose::SaveAs),
            Answer::Save => {
                if let Some(Question::Discard(then, _)) = question {
                    self.waiting.then = Some(then);
                }
                self.save_what_is_open();
            }
            Answer::Reload => self.reload_changed(),
            Answer::Overwrite => self.overwrite(),
            Answer::ReplaceFrames => self.replace_frames(),
            Answer::Beside => self.save_beside(),
            Answer::Path(purpose, path) if self.would_be_lost(purpose, &path) => {
                self.dialogs.question = Some(Question::Replace(purpose, path));
            }
            Answer::Path(purpose, path) | Answer::Replace(purpose, path) => self.chosen(purpose, Some(path)),
            Answer::Rename(purpose, path) => {
                self.browse(purpose, &path);
            }
            Answer::Discard(then) => self.go_on(then),
            Answer::Recover(project) => {
                self.session
                    .load(Source::Recovered(project), &self.viewport.gpu(), &self.workers);
            }
            Answer::Forget(projects) => projects.iter().for_each(|project| left::remove(project)),
            Answer::Cancel => {
                self.waiting.then = None;
                self.waiting.unwritten = None;
            }
        }
    }

    /// Returns true if saving under a path from the window's own dialog would replace a file other than the open one;
    /// the system's dialogs ask that themselves.
    fn would_be_lost(&self, purpose: Purpose, path: &Path) -> bool {
        let path = match purpose {
            Purpose::SaveProject => project_path(path.to_owned()),
            _ => path.to_owned(),
        };
        let open = self.session.open.as_ref();
        let is_own = open.is_some_and(|open| open.is_at(&path) || open.is_project_at(&path));
        file_dialog::asks_to_save(purpose) && path.is_file() && !is_own
    }
}
