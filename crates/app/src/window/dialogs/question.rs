//! Questions to the person: the system's file dialogs, and our own one before a source is written over.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use eframe::egui::{self, Id, Modal, RichText};
use pliant_io::quoted;

use crate::window::files::names::{file_name, original_name};
use crate::window::files::recovery::left::Left;
use crate::window::threads::message::{Message, Purpose};
use crate::window::threads::workers::Workers;

/// The kinds of file that open, by extension.
const MODELS: [&str; 6] = ["glb", "gltf", "obj", "ply", "stl", "off"];

/// Asks for a path by the system's dialog, which is made here, on the main thread, and awaited elsewhere. Where the
/// system has no dialog its answer is "none"; a typed path and drag and drop remain.
pub fn choose(purpose: Purpose, near: Option<&Path>, workers: &Workers) {
    let mut dialog = rfd::AsyncFileDialog::new();
    if let Some(folder) = near.and_then(Path::parent).filter(|folder| folder.is_dir()) {
        dialog = dialog.set_directory(folder);
    }
    if let Some(name) = near.map(file_name).filter(|_| purpose == Purpose::SaveAs) {
        dialog = dialog.set_file_name(name);
    }
    let answered =
        move |file: Option<rfd::FileHandle>| Message::Chosen(purpose, file.map(|file| file.path().to_owned()));
    let none = move |_| Message::Chosen(purpose, None);
    match purpose {
        Purpose::Open => {
            let answer = dialog
                .set_title("Open a model or a project")
                .add_filter("Models and projects", &[&MODELS[..], &["pliant"]].concat())
                .pick_file();
            workers.spawn("dialog", move || answered(pollster::block_on(answer)), none);
        }
        Purpose::SaveAs => {
            let answer = dialog
                .set_title("Save the model as")
                .add_filter("Models", &MODELS)
                .save_file();
            workers.spawn("dialog", move || answered(pollster::block_on(answer)), none);
        }
        Purpose::SaveMorph => {
            let answer = dialog
                .set_title("Save as morph target")
                .add_filter("glTF", &["glb", "gltf"])
                .set_file_name("morph.glb")
                .save_file();
            workers.spawn("dialog", move || answered(pollster::block_on(answer)), none);
        }
        Purpose::SaveProject => {
            let answer = dialog
                .set_title("Save the project as")
                .add_filter("Projects", &["pliant"])
                .save_file();
            workers.spawn("dialog", move || answered(pollster::block_on(answer)), none);
        }
        Purpose::ExportEdit => {
            let answer = dialog
                .set_title("Export the edit as")
                .set_file_name("edit.json")
                .save_file();
            workers.spawn("dialog", move || answered(pollster::block_on(answer)), none);
        }
        Purpose::LoadCage => {
            let answer = dialog
                .set_title("Load a cage")
                .add_filter("Models", &MODELS)
                .pick_file();
            workers.spawn("dialog", move || answered(pollster::block_on(answer)), none);
        }
        Purpose::SavePicture(_) => {
            let answer = dialog
                .set_title("Save the picture as")
                .set_file_name("picture.png")
                .save_file();
            workers.spawn("dialog", move || answered(pollster::block_on(answer)), none);
        }
    }
}

/// A question that waits for an answer; the window behind it does nothing meanwhile.
#[derive(Clone, PartialEq, Debug)]
pub enum Question {
    /// Whether the file that was opened may be written over.
    WriteOver(PathBuf),
    /// A path to type, where the system has no dialog.
    Path(Purpose, String),
    /// Whether a file that stands where a typed path leads may be replaced.
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
            Self::Path(Purpose::Open, _) => "Open a model",
            Self::Path(Purpose::SaveAs, _) => "Save the model as",
            Self::Path(Purpose::SaveMorph, _) => "Save as morph target",
            Self::Path(Purpose::SaveProject, _) => "Save the project as",
            Self::Recover(_) => "Recover unsaved work?",
            Self::Path(Purpose::ExportEdit, _) => "Export the edit",
            Self::Path(Purpose::LoadCage, _) => "Load a cage",
            Self::Path(Purpose::SavePicture(_), _) => "Save the picture as",
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
        ui.set_max_width(420.0);
        match question {
            Question::WriteOver(path) => write_over(ui, path, &mut answer),
            Question::Path(purpose, typed) => path(ui, *purpose, typed, &mut answer),
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

fn path(ui: &mut egui::Ui, purpose: Purpose, typed: &mut String, answer: &mut Option<Answer>) {
    let (heading, hint) = match purpose {
        Purpose::Open => (
            "Open a model",
            "The path of a .glb, .gltf, .obj, .ply, .stl or .off file, or of a .pliant project:",
        ),
        Purpose::SaveAs => (
            "Save the model as",
            "The path to save under; its extension chooses the format:",
        ),
        Purpose::SaveMorph => (
            "Save as morph target",
            "The path of the .glb or .gltf file; its name is the morph target's:",
        ),
        Purpose::SaveProject => ("Save the project as", "The path of the .pliant file:"),
        Purpose::ExportEdit => ("Export the edit", "The path of the .json file:"),
        Purpose::LoadCage => (
            "Load a cage",
            "The path of a closed mesh, a .glb, .gltf, .obj, .ply, .stl or .off file:",
        ),
        Purpose::SavePicture(_) => ("Save the picture", "The path of the .png file:"),
    };
    ui.heading(heading);
    ui.label(hint);
    // The keys are its own from the first frame on.
    let id = ui.scope_id().with("path");
    ui.memory_mut(|memory| memory.request_focus(id));
    ui.add(egui::TextEdit::singleline(typed).id(id).desired_width(f32::INFINITY));
    let entered = ui.input(|input| input.key_pressed(egui::Key::Enter));
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        let named = !typed.trim().is_empty();
        let clicked = ui
            .add_enabled(named, egui::Button::new(RichText::new("OK").strong()))
            .clicked();
        if named && (clicked || entered) {
            *answer = Some(Answer::Path(purpose, PathBuf::from(typed.trim())));
        }
        if ui.button("Cancel").clicked() {
            *answer = Some(Answer::Cancel);
        }
    });
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
    let button = ui.button(RichText::new(name).strong());
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
