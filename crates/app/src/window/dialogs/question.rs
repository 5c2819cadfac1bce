//! Questions that the window itself asks.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use eframe::egui::{self, Id, Modal, RichText};
use pliant_io::quoted;

use super::file_dialog;
use super::folder_browser::{FolderBrowser, view};
use crate::files::names::file_name;
use crate::files::original::Kept;
use crate::window::files::recovery::left::Left;
use crate::window::threads::message::Purpose;
use crate::window::widgets::default_button::default_button;

/// A question that waits for an answer; the window behind it does nothing in the meantime.
#[derive(Clone, PartialEq, Debug)]
pub enum Question {
    /// Whether the opened file may be replaced; with it the place of its original, kept or to be kept, once that is
    /// known.
    WriteOver(PathBuf, Option<Result<Kept, String>>),
    /// The choices for a file that another program has changed before a save.
    Changed(PathBuf, ChangedOffer),
    /// The path of a file, if the system has no dialog.
    File(Purpose, Box<FolderBrowser>),
    /// The replacement of the existing file at the chosen path.
    Replace(Purpose, PathBuf),
    /// The replacement of existing numbered files of an animation.
    ReplaceFrames {
        /// The first of them.
        first: PathBuf,
        /// Their number.
        count: usize,
    },
    /// The loss of unsaved work.
    Discard(Then, String),
    /// The recovery of earlier sessions' work.
    Recover(Vec<Left>),
}

impl Question {
    /// Its subject, for the window's title: people who don't see the window learn that it waits.
    pub fn title(&self) -> &'static str {
        match self {
            Self::WriteOver(..) => "Save over the source?",
            Self::Changed(..) => "The file has changed",
            Self::File(purpose, _) => file_dialog::title(*purpose),
            Self::Recover(_) => "Recover unsaved work?",
            Self::Replace(..) => "Replace the file?",
            Self::ReplaceFrames { .. } => "Replace the frames?",
            Self::Discard(..) => "There is unsaved work",
        }
    }
}

/// The options for a file that another program has changed, besides saving elsewhere and overwriting it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum ChangedOffer {
    /// Read it again, and apply the edit to it.
    Reload {
        /// The names of the steps that have changed the mesh and are in no file: they are lost.
        lost: Vec<&'static str>,
    },
    /// No further option.
    Others,
}

/// The request that was interrupted by unsaved work.
#[derive(Clone, PartialEq, Debug)]
pub enum Then {
    /// Open this file, or ask for one.
    Open(Option<PathBuf>),
    /// Ask for a sequence to open.
    OpenSequence,
    /// Open the built-in sample.
    Sample,
    /// Close the window.
    Close,
}

/// The person's answer.
#[derive(Clone, PartialEq, Debug)]
pub enum Answer {
    /// Write over the file and keep the original beside it.
    WriteOver(PathBuf),
    /// Save under another name instead.
    SaveAs,
    /// Save first.
    Save,
    /// This path.
    Path(Purpose, PathBuf),
    /// This path, even if it exists.
    Replace(Purpose, PathBuf),
    /// Read the file that another program has changed again, and apply the edit to it.
    Reload,
    /// Replace the existing numbered files.
    ReplaceFrames,
    /// Replace the file that another program has changed.
    Overwrite,
    /// Save under another name than the file that another program has changed.
    Beside,
    /// Another path than this one.
    Rename(Purpose, PathBuf),
    /// Continue and lose the unsaved work.
    Discard(Then),
    /// Open the work of an earlier session.
    Recover(PathBuf),
    /// Delete the work of earlier sessions.
    Forget(Vec<PathBuf>),
    /// Cancel.
    Cancel,
}

/// Shows a question; `Some` after the answer.
pub fn ask(context: &egui::Context, question: &mut Question) -> Option<Answer> {
    let mut answer = None;
    let response = Modal::new(Id::unique("question")).show(context, |ui| {
        if !matches!(question, Question::File(..)) {
            ui.set_max_width(420.0);
        }
        match question {
            Question::WriteOver(path, kept) => write_over(ui, path, kept.as_ref(), &mut answer),
            Question::Changed(path, offer) => changed(ui, path, offer, &mut answer),
            Question::File(purpose, browser) => file(ui, *purpose, browser, &mut answer),
            Question::Replace(purpose, path) => replace(ui, *purpose, path, &mut answer),
            Question::ReplaceFrames { first, count } => replace_frames(ui, first, *count, &mut answer),
            Question::Discard(then, name) => discard(ui, then, name, &mut answer),
            Question::Recover(left) => recover(ui, left, &mut answer),
        }
    });
    if answer.is_none() && response.should_close() {
        answer = Some(Answer::Cancel);
    }
    answer
}

fn write_over(ui: &mut egui::Ui, path: &Path, kept: Option<&Result<Kept, String>>, answer: &mut Option<Answer>) {
    ui.heading(format!("Save over {}?", file_name(path)));
    ui.label(match kept {
        None => "The current file is kept beside it.".to_owned(),
        Some(Ok(Kept::Already(kept))) => format!("The original is already kept as {}.", file_name(kept)),
        Some(Ok(Kept::Under(kept))) => format!("The current file is kept beside it as {}.", file_name(kept)),
        Some(Ok(Kept::Nothing)) => "The file was deleted from the disk; saving writes it again.".to_owned(),
        Some(Err(sentence)) => format!("The current file can't be kept: {sentence}"),
    });
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        if main_button(ui, "Save") {
            *answer = Some(Answer::WriteOver(path.to_owned()));
        }
        if ui.button("Save as…").clicked() {
            *answer = Some(Answer::SaveAs);
        }
        if ui.button("Cancel").clicked() {
            *answer = Some(Answer::Cancel);
        }
    });
}

fn changed(ui: &mut egui::Ui, path: &Path, offer: &ChangedOffer, answer: &mut Option<Answer>) {
    let name = file_name(path);
    ui.heading(format!("{name} has changed"));
    ui.label("Another program or window has written this file since it was read or saved here.");
    if let ChangedOffer::Reload { lost } = offer {
        ui.label("Reloading opens the changed file with your edit. The steps so far can then no longer be undone.");
        if !lost.is_empty() {
            let steps = lost.join(", ");
            ui.label(format!(
                "These changes of the mesh are in no file, and reloading loses them: {steps}."
            ));
        }
    }
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        if let ChangedOffer::Reload { lost } = offer {
            let name = match lost.is_empty() {
                true => "Reload with the edit",
                false => "Reload and lose them",
            };
            if ui.button(name).clicked() {
                *answer = Some(Answer::Reload);
            }
        }
        if main_button(ui, "Save beside…") {
            *answer = Some(Answer::Beside);
        }
        if ui.button("Overwrite").clicked() {
            *answer = Some(Answer::Overwrite);
        }
        if ui.button("Cancel").clicked() {
            *answer = Some(Answer::Cancel);
        }
    });
}

fn replace(ui: &mut egui::Ui, purpose: Purpose, path: &Path, answer: &mut Option<Answer>) {
    ui.heading(format!("Replace {}?", file_name(path)));
    ui.label("A file of this name exists. Saving here replaces it.");
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        if main_button(ui, "Another name…") {
            *answer = Some(Answer::Rename(purpose, path.to_owned()));
        }
        if ui.button("Replace").clicked() {
            *answer = Some(Answer::Replace(purpose, path.to_owned()));
        }
        if ui.button("Cancel").clicked() {
            *answer = Some(Answer::Cancel);
        }
    });
}

fn replace_frames(ui: &mut egui::Ui, first: &Path, count: usize, answer: &mut Option<Answer>) {
    let files = if count == 1 {
        "1 file".to_owned()
    } else {
        format!("{count} files")
    };
    ui.heading(format!("Replace {files}?"));
    ui.label(format!(
        "Files with the names of the frames exist, the first of them {}. Exporting here replaces them.",
        file_name(first)
    ));
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        if main_button(ui, "Another name…") {
            *answer = Some(Answer::Beside);
        }
        if ui.button("Replace").clicked() {
            *answer = Some(Answer::ReplaceFrames);
        }
        if ui.button("Cancel").clicked() {
            *answer = Some(Answer::Cancel);
        }
    });
}

fn file(ui: &mut egui::Ui, purpose: Purpose, browser: &mut FolderBrowser, answer: &mut Option<Answer>) {
    if view::show(ui, file_dialog::title(purpose), browser) {
        *answer = Some(Answer::Cancel);
    }
    if let Some(path) = browser.take_found() {
        *answer = Some(Answer::Path(purpose, path));
    }
}

fn recover(ui: &mut egui::Ui, left: &[Left], answer: &mut Option<Answer>) {
    ui.heading("Recover unsaved work?");
    ui.label("Pliant ended before this was saved. Recover it, or delete it for good.");
    ui.add_space(8.0);
    egui::Grid::new("left").show(ui, |ui| {
        for (number, left) in left.iter().enumerate() {
            let name = left.name.as_deref().map_or_else(|| "a model".to_owned(), quoted);
            ui.label(RichText::new(name).strong());
            ui.label(RichText::new(ago(left.written)).weak());
            let is_chosen = match number {
                0 => main_button(ui, "Recover"),
                _ => ui.button("Recover").clicked(),
            };
            if is_chosen {
                *answer = Some(Answer::Recover(left.project.clone()));
            }
            ui.end_row();
        }
    });
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        let name = if left.len() > 1 { "Delete all" } else { "Delete" };
        if ui.button(name).clicked() {
            *answer = Some(Answer::Forget(left.iter().map(|left| left.project.clone()).collect()));
        }
        if ui.button("Later").clicked() {
            *answer = Some(Answer::Cancel);
        }
    });
}

/// The answer that Enter gives: it has the focus until another is chosen.
fn main_button(ui: &mut egui::Ui, name: &str) -> bool {
    let button = ui.add(default_button(ui, name));
    if ui.memory(|memory| memory.focused().is_none()) {
        button.request_focus();
    }
    button.clicked()
}

/// "kept 3 minutes ago".
fn ago(written: SystemTime) -> String {
    let seconds = written.elapsed().map_or(0, |elapsed| elapsed.as_secs());
    let (count, unit) = match seconds {
        0..120 => return "kept a moment ago".to_owned(),
        120..7200 => (seconds / 60, "minutes"),
        7200..172_800 => (seconds / 3600, "hours"),
        _ => (seconds / 86_400, "days"),
    };
    format!("kept {count} {unit} ago")
}

fn discard(ui: &mut egui::Ui, then: &Then, name: &str, answer: &mut Option<Answer>) {
    ui.heading("There is unsaved work");
    let end = match then {
        Then::Open(_) | Then::Sample => "Opening another file discards them.",
        Then::Close => "Closing the window discards them.",
        Then::OpenSequence => "Opening a sequence discards them.",
    };
    ui.label(format!("{} does not have your last changes. {end}", quoted(name)));
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        if main_button(ui, "Save first") {
            *answer = Some(Answer::Save);
        }
        if ui.button("Don't save").clicked() {
            *answer = Some(Answer::Discard(then.clone()));
        }
        if ui.button("Cancel").clicked() {
            *answer = Some(Answer::Cancel);
        }
    });
}
