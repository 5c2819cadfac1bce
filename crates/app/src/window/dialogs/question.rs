//! Questions to the person that the window itself asks.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use eframe::egui::{self, Id, Modal, RichText};
use pliant_io::quoted;

use super::file_dialog;
use super::folder_browser::{FolderBrowser, view};
use crate::window::files::names::{file_name, original_name};
use crate::window::files::recovery::left::Left;
use crate::window::threads::message::Purpose;
use crate::window::widgets::default_button::default_button;

/// A question that waits for an answer; the window behind it does nothing meanwhile.
#[derive(Clone, PartialEq, Debug)]
pub enum Question {
    /// Whether the file that was opened may be written over.
    WriteOver(PathBuf),
    /// For a file, where the system has no dialog.
    File(Purpose, Box<FolderBrowser>),
    /// Whether a file that stands where the chosen path leads may be replaced.
    Replace(Purpose, PathBuf),
    /// Whether unsaved work may be lost.
    Discard(Then),
    /// Whether what earlier sessions have left is to be opened.
    Recover(Vec<Left>),
}

impl Question {
    /// What it is about, for the window's title: who doesn't see the window learns that it waits.
    pub fn title(&self) -> &'static str {
        match self {
            Self::WriteOver(_) => "Save over the source?",
            Self::File(purpose, _) => file_dialog::title(*purpose),
            Self::Recover(_) => "Recover unsaved work?",
            Self::Replace(..) => "Replace the file?",
            Self::Discard(_) => "There is unsaved work",
        }
    }
}

/// What was asked for when unsaved work stood in the way.
#[derive(Clone, PartialEq, Debug)]
pub enum Then {
    /// Opening this file, or asking which.
    Open(Option<PathBuf>),
    /// Closing the window.
    Close,
}

/// What the person answered.
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
    /// This path, whatever stands there.
    Replace(Purpose, PathBuf),
    /// Another path than this one.
    Rename(Purpose, PathBuf),
    /// Go on and lose the unsaved work.
    Discard(Then),
    /// Open what an earlier session has left.
    Recover(PathBuf),
    /// Delete what earlier sessions have left.
    Forget(Vec<PathBuf>),
    /// Nothing after all.
    Cancel,
}

/// Shows a question; `Some` once it is answered.
pub fn ask(context: &egui::Context, question: &mut Question) -> Option<Answer> {
    let mut answer = None;
    let response = Modal::new(Id::unique("question")).show(context, |ui| {
        if !matches!(question, Question::File(..)) {
            ui.set_max_width(420.0);
        }
        match question {
            Question::WriteOver(path) => write_over(ui, path, &mut answer),
            Question::File(purpose, browser) => file(ui, *purpose, browser, &mut answer),
            Question::Replace(purpose, path) => replace(ui, *purpose, path, &mut answer),
            Question::Discard(then) => discard(ui, then, &mut answer),
            Question::Recover(left) => recover(ui, left, &mut answer),
        }
    });
    if answer.is_none() && response.should_close() {
        answer = Some(Answer::Cancel);
    }
    answer
}

fn write_over(ui: &mut egui::Ui, path: &Path, answer: &mut Option<Answer>) {
    ui.heading(format!("Save over {}?", file_name(path)));
    let kept = original_name(path);
    let sentence = if kept.exists() {
        format!("The original is kept already, as {}.", file_name(&kept))
    } else {
        format!("The file as it is now is kept beside it as {}.", file_name(&kept))
    };
    ui.label(sentence);
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

fn replace(ui: &mut egui::Ui, purpose: Purpose, path: &Path, answer: &mut Option<Answer>) {
    ui.heading(format!("Replace {}?", file_name(path)));
    ui.label("There is such a file already, which is lost then.");
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
    ui.label("Pliant ended before this was saved. Recover it and save it, or delete it for good.");
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

fn discard(ui: &mut egui::Ui, then: &Then, answer: &mut Option<Answer>) {
    ui.heading("There is unsaved work");
    ui.label(match then {
        Then::Open(_) => "Opening another file closes this one.",
        Then::Close => "Closing the window ends it.",
    });
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
