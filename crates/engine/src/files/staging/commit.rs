//! Renames staged files into place, and restores the replaced files if a rename fails.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use super::{Staged, StagedFile};
use crate::file_error::FileError;
use crate::files::Destination;
use crate::files::leftovers::{self, PREFIX, REPLACED, TEMPORARY};
use crate::files::lock::Share;
use crate::path_text::folder_of;

impl Staged {
    /// Renames every file into place, in order, and syncs the folders.
    ///
    /// # Errors
    /// A rename fails. Then the files that were replaced before it are restored.
    pub fn commit(self) -> Result<(), FileError> {
        self.commit_watched(&mut || {})
    }

    /// Like [`Self::commit`]; `before_each` is called before each change in the folders.
    ///
    /// # Errors
    /// Those of [`Self::commit`].
    pub fn commit_watched(mut self, before_each: &mut dyn FnMut()) -> Result<(), FileError> {
        let staging = self.staging.clone();
        let mut state = staging.lock();
        let mut files = std::mem::take(&mut self.files);
        let mut passing = Passing(Vec::new());
        let mut first = Vec::new();
        for bridge in self.bridges.drain(..) {
            for (file, path) in bridge.passing {
                before_each();
                second_name(&files[file].temporary, &path).map_err(|error| FileError::writing(&path, error))?;
                passing.0.push(path);
            }
            // The bridge must not become durable before the files that it names.
            sync_folder(&bridge.file.to.home);
            first.push(bridge.file);
        }
        files.splice(0..0, first);
        let mut done = Done::default();
        let last = files.len().saturating_sub(1);
        for (i, file) in files.into_iter().enumerate() {
            let StagedFile {
                to,
                temporary,
                other_names,
            } = file;
            before_each();
            // No other rename can fail after the last one, so it needs no backup.
            let renamed = make_folders(folder_of(&to.target), &mut done.folders)
                .and_then(|()| if i == last { Ok(None) } else { backup(&to) })
                .and_then(|backup| {
                    temporary.persist(&to.target).map_err(|error| error.error)?;
                    Ok(backup)
                });
            match renamed {
                Ok(backup) => {
                    // The next rename must not become durable before this one.
                    sync_folder(folder_of(&to.target));
                    done.other_names
                        .extend(other_names.here.into_iter().map(|name| (to.target.clone(), name)));
                    done.replaced.push((to.target, backup));
                }
                Err(error) => {
                    done.put_back();
                    return Err(FileError::writing(&to.given, error));
                }
            }
        }
        before_each();
        // Each other name is a separate step: a name that can't be replaced keeps the old content.
        for (target, name) in std::mem::take(&mut done.other_names) {
            let _ = bring_along(&target, &name);
        }
        drop((passing, done));
        // Files that a killed save left under passing names were named by the files that have just been replaced.
        self.held
            .0
            .iter()
            .filter(|lock| lock.share == Share::Alone)
            .for_each(|lock| leftovers::clear(&lock.folder));
        state.temporary.clear();
        state.committed = true;
        Ok(())
    }
}

/// The changes of a commit so far.
#[derive(Default)]
struct Done {
    /// Targets, and their earlier files.
    replaced: Vec<(PathBuf, Option<TempPath>)>,
    /// Folders that were made, outer ones first.
    folders: Vec<PathBuf>,
    /// Targets and other names of their earlier files.
    other_names: Vec<(PathBuf, PathBuf)>,
}

impl Done {
    fn put_back(self) {
        for (target, backup) in self.replaced.into_iter().rev() {
            // The first error is the one to report; a second one has no better remedy.
            let _ = match backup {
                Some(backup) => backup.persist(&target).map_err(|error| error.error),
                None => fs::remove_file(&target),
            };
        }
        for folder in self.folders.into_iter().rev() {
            // A folder to which somebody has added a file stays.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Makes a folder and its missing parents, and adds them to `made`.
fn make_folders(folder: &Path, made: &mut Vec<PathBuf>) -> io::Result<()> {
    if folder.is_dir() {
        return Ok(());
    }
    if let Some(parent) = folder.parent() {
        make_folders(parent, made)?;
    }
    fs::create_dir(folder)?;
    made.push(folder.to_owned());
    Ok(())
}

/// Files under passing names, removed when this is dropped.
struct Passing(Vec<PathBuf>);

impl Drop for Passing {
    fn drop(&mut self) {
        for path in &self.0 {
            // A file that can't be removed does no harm.
            let _ = fs::remove_file(path);
        }
    }
}

/// A second name for the existing file at a destination, if there is one.
fn backup(to: &Destination) -> io::Result<Option<TempPath>> {
    if !to.target.exists() {
        return Ok(None);
    }
    let name = tempfile::Builder::new()
        .prefix(PREFIX)
        .suffix(REPLACED)
        .make_in(&to.home, |path| second_name(&to.target, path))?;
    Ok(Some(name.into_temp_path()))
}

/// Makes another name of a replaced file lead to the new one.
fn bring_along(target: &Path, name: &Path) -> io::Result<()> {
    let temporary = tempfile::Builder::new()
        .prefix(PREFIX)
        .suffix(TEMPORARY)
        .make_in(folder_of(name), |path| fs::hard_link(target, path))?;
    temporary.into_temp_path().persist(name).map_err(|error| error.error)
}

/// Makes the bytes of `file` available at `path` as well, where no file may exist yet.
fn second_name(file: &Path, path: &Path) -> io::Result<()> {
    match fs::hard_link(file, path) {
        Err(error) if error.kind() != ErrorKind::AlreadyExists => {
            // Not every file system has hard links.
            let mut options = fs::OpenOptions::new();
            options.write(true).create_new(true);
            #[cfg(unix)]
            std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
            let mut copy = options.open(path)?;
            io::copy(&mut File::open(file)?, &mut copy)?;
            copy.set_permissions(fs::metadata(file)?.permissions())?;
            copy.sync_all()
        }
        done => done,
    }
}

/// Makes a rename survive a power cut. Not every system can open a folder for that, and the files are whole in any
/// case.
fn sync_folder(folder: &Path) {
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}
