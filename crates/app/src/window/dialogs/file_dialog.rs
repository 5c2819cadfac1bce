//! Asking a person for a file: by the system's dialog, or else by the window's own folder browser.

use std::path::{Path, PathBuf};
use std::pin::Pin;

use rfd::FileHandle;

use super::folder_browser::{Asked, FolderBrowser, Place};
use super::system_dialog;
use crate::files::names::file_name;
use crate::window::threads::message::{Message, Purpose};
use crate::window::threads::workers::Workers;
use pliant_engine::files::folder_of;
use pliant_io::Format;

/// The kinds of mesh file.
const MODELS: &[&str] = &Format::EXTENSIONS;

/// The kinds of mesh file, and projects.
const MODELS_AND_PROJECTS: &[&str] = &after_models::<{ Format::EXTENSIONS.len() + 1 }>("pliant", "pliant");

/// The kinds of mesh file, and point caches.
const MODELS_AND_CACHES: &[&str] = &after_models::<{ Format::EXTENSIONS.len() + 2 }>("pc2", "mdd");

/// The kinds of mesh file, and after them `next` and `last`, as far as there is room.
const fn after_models<const COUNT: usize>(next: &'static str, last: &'static str) -> [&'static str; COUNT] {
    let mut endings = [last; COUNT];
    let mut place = 0;
    while place < Format::EXTENSIONS.len() {
        endings[place] = Format::EXTENSIONS[place];
        place += 1;
    }
    endings[place] = next;
    endings
}

/// The extensions of animations: one file, or with `-####` in its name one for each frame.
const ANIMATIONS: &[&str] = &["glb", "gltf", "pc2", "mdd", "obj", "ply", "stl", "off", "3mf", "usdz"];

/// The formats of models that have vertex colours.
const COLOURED: &[&str] = &["glb", "gltf", "ply", "obj", "off"];

/// The purpose of a dialog.
struct Request {
    title: &'static str,
    asked: Asked,
    /// The name of the kind of files, and their extensions.
    kind: &'static str,
    endings: &'static [&'static str],
}

fn request(purpose: Purpose) -> Request {
    let (title, asked, kind, endings): (_, _, _, &[&str]) = match purpose {
        Purpose::Open => (
            "Open a model or a project",
            Asked::ToOpen,
            "Models and projects",
            MODELS_AND_PROJECTS,
        ),
        Purpose::OpenSequence => (
            "Open a sequence: one of its frames, or its point cache",
            Asked::ToOpen,
            "Models and point caches",
            MODELS_AND_CACHES,
        ),
        Purpose::Mix => (
            "Mix with a sequence: one of its frames, or its point cache",
            Asked::ToOpen,
            "Models and point caches",
            MODELS_AND_CACHES,
        ),
        Purpose::ApplyEdit => ("Apply an edit", Asked::ToOpen, "Edits", &["json"]),
        Purpose::Append => ("Append a file", Asked::ToOpen, "Models", MODELS),
        Purpose::LoadCage => ("Load a cage", Asked::ToOpen, "Models", MODELS),
        Purpose::AddExample => ("Add an example", Asked::ToOpen, "Models", MODELS),
        Purpose::SaveAs => ("Save the model as", Asked::ToSave, "Models", MODELS),
        Purpose::SaveMorph => ("Save as morph target", Asked::ToSave, "glTF", &["glb", "gltf"]),
        Purpose::SaveProject => ("Save the project as", Asked::ToSave, "Projects", &["pliant"]),
        Purpose::ExportEdit => ("Export the edit", Asked::ToSave, "Edits", &["json"]),
        Purpose::ExportAnimation => ("Export the animation", Asked::ToSave, "Animations", ANIMATIONS),
        // A folder, or a file of the sequence's kind.
        Purpose::ExportFrames => ("Export the frames", Asked::ToSave, "Folders and files", &[]),
        Purpose::ExportFlow => ("Export the flow", Asked::ToSave, "Models with colours", COLOURED),
        Purpose::SavePicture(_) => ("Save the picture as", Asked::ToSave, "Pictures", &["png"]),
    };
    Request {
        title,
        asked,
        kind,
        endings,
    }
}

/// Returns true if a dialog for this purpose asks for a path to write to.
pub fn asks_to_save(purpose: Purpose) -> bool {
    request(purpose).asked == Asked::ToSave
}

/// The title of a dialog for this purpose.
pub fn title(purpose: Purpose) -> &'static str {
    request(purpose).title
}

/// Asks for a path by the system's dialog, which is made here, on the main thread, and awaited elsewhere. It begins in
/// the folder of `suggested`, whose name is the one to save under. If the system has no dialog, this is reported, and
/// the folder browser takes its place.
pub fn choose(purpose: Purpose, suggested: &Path, workers: &Workers) {
    let request = request(purpose);
    let mut dialog = rfd::AsyncFileDialog::new().set_title(request.title);
    if !request.endings.is_empty() {
        dialog = dialog.add_filter(request.kind, request.endings);
    }
    if let Some(folder) = suggested.parent().filter(|folder| folder.is_dir()) {
        dialog = dialog.set_directory(folder);
    }
    let answer: Pin<Box<dyn Future<Output = Option<FileHandle>> + Send>> = match request.asked {
        Asked::ToOpen => Box::pin(dialog.pick_file()),
        Asked::ToSave => Box::pin(dialog.set_file_name(file_name(suggested)).save_file()),
    };
    let [missing, failed] = [suggested.to_owned(), suggested.to_owned()];
    workers.spawn(
        "dialog",
        move || {
            let file = pollster::block_on(answer);
            match file {
                Some(file) => Message::Chosen(purpose, Some(file.path().to_owned())),
                None if system_dialog::is_there() => Message::Chosen(purpose, None),
                None => Message::NoDialog(purpose, missing),
            }
        },
        move |_| Message::NoDialog(purpose, failed.clone()),
    );
}

/// The window's own dialog, which begins at `suggested` and offers the folders of the open file and of the `recent`
/// ones.
pub fn browser(purpose: Purpose, suggested: &Path, open: Option<&Path>, recent: &[PathBuf]) -> FolderBrowser {
    let request = request(purpose);
    let home = dirs::home_dir();
    let mut places: Vec<Place> = Vec::new();
    let mut offer = |name: Option<&str>, folder: &Path| {
        if folder.is_absolute() && places.iter().all(|place| place.folder != folder) {
            let name = name.map_or_else(|| file_name(folder), str::to_owned);
            let folder = folder.to_owned();
            places.push(Place { name, folder });
        }
    };
    if let Some(home) = &home {
        offer(Some("Home"), home);
    }
    for file in open.into_iter().chain(recent.iter().map(PathBuf::as_path)) {
        offer(None, folder_of(file));
    }
    // A bare name goes to the folder of the last files, or to the home folder.
    let last = places.get(1).or(places.first());
    let suggested = match last {
        Some(last) if !suggested.is_absolute() => last.folder.join(suggested),
        _ => suggested.to_owned(),
    };
    let begin = match request.asked {
        Asked::ToOpen => folder_of(&suggested).to_owned(),
        Asked::ToSave => suggested,
    };
    FolderBrowser::new(request.asked, request.endings, &begin, places, home)
}
