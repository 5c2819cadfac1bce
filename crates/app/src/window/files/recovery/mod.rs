//! The work that a session leaves for the next one if it ends without saving: a project, written every few seconds
//! while there is unsaved work, and deleted when the work is saved or the window is closed.
//!
//! Each session holds a lock on a file of its own. The system releases it however the process ends, so a project whose
//! lock is free belongs to a session that has ended.

pub mod left;

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use pliant_editor::{Snapshot, SnapshotKey};

use self::left::remove;
use super::project_file;
use super::rest_mesh::RestMesh;
use pliant_engine::files::shown;

/// The interval between writes of unsaved work. A write takes less than a second even on a large mesh, so no more than
/// twice this time can be lost.
const EVERY: Duration = Duration::from_secs(8);

/// The keeper of one session's work.
#[derive(Debug)]
pub struct Recovery {
    project: PathBuf,
    lock_path: PathBuf,
    _lock: File,
    /// The state that was written last, and the one that is being written.
    kept: Option<SnapshotKey>,
    writing: Option<SnapshotKey>,
    last: Instant,
    every: Duration,
    /// True if the last write failed, which is reported once.
    failed: bool,
}

/// The work to be written.
#[derive(Clone)]
pub struct Work {
    snapshot: Snapshot,
    mesh: RestMesh,
    /// The path of the open model, for the person who recovers the work.
    model: Option<PathBuf>,
    /// The path of the open project, likewise.
    opened: Option<PathBuf>,
    project: PathBuf,
}

/// The newest state of the window that runs in this process, for the moment of a panic.
static LATEST: Mutex<Option<Work>> = Mutex::new(None);

impl Recovery {
    /// Begins to keep a session's work in `folder`.
    ///
    /// # Errors
    /// If the folder or the lock can't be made, in a sentence.
    pub fn begin(folder: &Path) -> Result<Self, String> {
        let refuse =
            |error: std::io::Error| format!("unsaved work can't be kept in {} ({error}): save often", shown(folder));
        make_private_folder(folder).map_err(refuse)?;
        for number in 0..1000 {
            let name = format!("session-{}-{number}", std::process::id());
            let lock_path = folder.join(&name).with_extension("lock");
            let lock = private_file(&lock_path).map_err(refuse)?;
            if lock.try_lock().is_ok() && !folder.join(&name).with_extension("pliant").exists() {
                return Ok(Self {
                    project: folder.join(&name).with_extension("pliant"),
                    lock_path,
                    _lock: lock,
                    kept: None,
                    writing: None,
                    last: Instant::now(),
                    every: EVERY,
                    failed: false,
                });
            }
        }
        Err(refuse(std::io::Error::other("a thousand sessions exist already")))
    }

    /// Takes the present state and returns the work to be written now, if any, for [`Work::write`] on another thread.
    /// The last argument is the open model and the open project.
    pub fn note(
        &mut self,
        key: SnapshotKey,
        unsaved: bool,
        snapshot: impl FnOnce() -> Option<Snapshot>,
        mesh: &RestMesh,
        [model, opened]: [Option<&Path>; 2],
    ) -> Option<Work> {
        if !unsaved {
            self.forget(key);
            return None;
        }
        if self.writing.is_some() || self.kept == Some(key) {
            return None;
        }
        let work = Work {
            snapshot: snapshot()?,
            mesh: mesh.clone(),
            model: model.map(Path::to_owned),
            opened: opened.map(Path::to_owned),
            project: self.project.clone(),
        };
        *LATEST.lock().unwrap_or_else(PoisonError::into_inner) = Some(work.clone());
        if self.kept.is_some() && self.last.elapsed() < self.every {
            return None;
        }
        self.writing = Some(key);
        Some(work)
    }

    /// Returns true if this state was written.
    pub fn has(&self, key: SnapshotKey) -> bool {
        self.kept == Some(key) && !self.failed
    }

    /// The time when the window should check again even if nothing happens; `None` while nothing waits.
    pub fn wait(&self, key: SnapshotKey, unsaved: bool) -> Option<Duration> {
        (unsaved && self.kept != Some(key)).then(|| self.every.saturating_sub(self.last.elapsed()))
    }

    /// A write has ended. A sentence if it failed, once.
    pub fn written(&mut self, key: SnapshotKey, result: Result<(), String>) -> Option<String> {
        self.writing = None;
        self.last = Instant::now();
        // A failed write counts as well: the next one comes after another change.
        self.kept = Some(key);
        match result {
            Ok(()) => {
                self.failed = false;
                None
            }
            Err(sentence) => {
                let is_new = !std::mem::replace(&mut self.failed, true);
                is_new.then(|| format!("Unsaved work can't be kept for recovery: {sentence}"))
            }
        }
    }

    /// There is nothing to recover.
    fn forget(&mut self, key: SnapshotKey) {
        if self.writing.is_none() && self.kept.is_some() {
            self.kept = None;
            remove(&self.project);
        }
        let mut latest = LATEST.lock().unwrap_or_else(PoisonError::into_inner);
        if latest.is_some() && self.writing != Some(key) {
            *latest = None;
        }
    }
}

impl Drop for Recovery {
    /// The window closes normally: the person was asked about unsaved work.
    fn drop(&mut self) {
        if std::thread::panicking() {
            return;
        }
        *LATEST.lock().unwrap_or_else(PoisonError::into_inner) = None;
        remove(&self.project);
        let _ = fs::remove_file(&self.lock_path);
    }
}

impl Work {
    /// Writes it, with a copy of its mesh: the file may be changed, moved or deleted before anybody recovers it.
    ///
    /// # Errors
    /// The obstacle, in a sentence.
    pub fn write(&self) -> Result<(), String> {
        let write = || {
            left::note_opened(&self.project, self.opened.as_deref())?;
            project_file::write_with_mesh(&self.snapshot, &self.mesh, self.model.as_deref(), &self.project)
        };
        write().map_err(|error| error.to_string())
    }
}

/// Writes the newest state at once, in the middle of a panic; returns the path, if there was one.
pub fn write_latest() -> Option<PathBuf> {
    // The thread that holds it may be the one that panics.
    let work = LATEST.try_lock().ok()?.clone()?;
    work.write().ok().map(|()| work.project)
}

/// Makes a folder that only its owner may read.
pub fn make_private_folder(folder: &Path) -> std::io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{DirBuilderExt, PermissionsExt};
        fs::DirBuilder::new().recursive(true).mode(0o700).create(folder)?;
        // A folder from an earlier version may be readable by everyone.
        fs::set_permissions(folder, fs::Permissions::from_mode(0o700))
    }
    #[cfg(not(unix))]
    fs::create_dir_all(folder)
}

/// Makes or opens a file that only its owner may read.
fn private_file(path: &Path) -> std::io::Result<File> {
    let mut options = fs::OpenOptions::new();
    options.write(true).create(true).truncate(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.open(path)
}

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that can't go on fails, and the child says what it did"
)]
mod tests;
