//! The remains of sessions that ended without saving.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::files::names::sources_of;
use crate::window::files::project_file;
use pliant_engine::EngineError;
use pliant_engine::files::{self, Staging};

/// The name of the note about the project that was open.
const OPENED: &str = "opened";

/// A session that ended without saving.
#[derive(Clone, PartialEq, Debug)]
pub struct Left {
    /// Its project.
    pub project: PathBuf,
    /// The name of the model, if it is known.
    pub name: Option<String>,
    /// The time when it was written.
    pub written: SystemTime,
}

/// The sessions in `folder` that ended without saving, the newest first.
pub fn left_in(folder: &Path) -> Vec<Left> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut left: Vec<Left> = entries
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|path| pliant_engine::is_project(path) && is_gone(&path.with_extension("lock")))
        .map(|project| {
            let written = fs::metadata(&project).and_then(|metadata| metadata.modified());
            Left {
                written: written.unwrap_or(SystemTime::UNIX_EPOCH),
                name: project_file::mesh_name(&project),
                project,
            }
        })
        .collect();
    left.sort_by_key(|left| std::cmp::Reverse(left.written));
    left
}

/// Notes beside a session's work the open project, if there was one.
///
/// # Errors
/// If it can't be written.
pub fn note_opened(project: &Path, opened: Option<&Path>) -> Result<(), EngineError> {
    let note = project.with_extension(OPENED);
    let Some(opened) = opened else {
        // A missing file needs no deletion.
        let _ = fs::remove_file(note);
        return Ok(());
    };
    let text = files::path_as_text(opened);
    Staging::private().stage([(note, text.as_bytes())])?.commit()?;
    Ok(())
}

/// The project that was open in the session with this work; `None` if none was, or if it is gone or was written since.
pub fn opened_project(project: &Path) -> Option<PathBuf> {
    let text = files::read_text(&project.with_extension(OPENED)).ok()?;
    let opened = files::path_of_text(Path::new("/"), &text);
    let written = |path: &Path| fs::metadata(path).and_then(|metadata| metadata.modified()).ok();
    (written(&opened)? <= written(project)?).then_some(opened)
}

/// Deletes the remains of a session.
pub fn remove(project: &Path) {
    // A missing file needs no deletion.
    let _ = fs::remove_file(project);
    let _ = fs::remove_file(project.with_extension(OPENED));
    for mesh in sources_of(project) {
        let _ = fs::remove_file(mesh);
    }
    if is_gone(&project.with_extension("lock")) {
        let _ = fs::remove_file(project.with_extension("lock"));
    }
}

/// Returns true if nobody holds the lock.
fn is_gone(lock: &Path) -> bool {
    match File::open(lock) {
        Ok(file) => file.try_lock().is_ok(),
        Err(_) => true,
    }
}
