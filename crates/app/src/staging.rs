//! Saving several files at once, so that either all of them are there in the end or none was touched.
//!
//! It goes in two steps. [`Staging::stage`] writes every file's bytes under a temporary name beside its target and
//! syncs them: whatever can fail for want of space or rights fails here. [`Staged::commit`] then renames them into
//! place, one after the other, and puts back what it replaced should a rename fail after all.
//!
//! Between two renames the power may fail. A file that names others must not then stand beside others than it was
//! written with: a [`Bridge`] is such a file that names its neighbours by names of their own, under which their bytes
//! stand for the while. It is renamed into place first, then the neighbours, then the file itself; at every moment what
//! stands there is the old state or the new one, whole.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use pliant_mesh::{Cancel, Progress};
use tempfile::{NamedTempFile, TempPath};

use crate::AppError;
use crate::files::{FileError, folder_of};

/// Bytes written between two looks at whether they are still wanted.
const BLOCK: usize = 1 << 22;

/// Bytes after which they are made to last: what the system only remembers is not written yet, and the bar would stand
/// at its end for as long as the disk takes.
const LASTING: usize = 1 << 26;

/// The temporary files of a save that is under way, so that an interrupt can take them away. Cloning shares them.
#[derive(Clone, Debug, Default)]
pub struct Staging(Arc<Mutex<State>>);

#[derive(Debug, Default)]
struct State {
    temporary: Vec<PathBuf>,
    committed: bool,
}

/// Files that are written and synced under temporary names; dropping them takes them away again.
#[derive(Debug)]
pub struct Staged {
    files: Vec<StagedFile>,
    bridges: Vec<StagedBridge>,
    /// Folders that were made for them, outer ones first.
    folders: Vec<PathBuf>,
    staging: Staging,
}

#[derive(Debug)]
struct StagedFile {
    /// The path as the person gave it, for messages.
    name: PathBuf,
    /// The path that is replaced: a link's target rather than the link.
    target: PathBuf,
    temporary: TempPath,
}

/// What stands in a file's place while its neighbours are replaced.
#[derive(Clone, Copy, Debug)]
pub struct Bridge<'a> {
    /// The file's name, one of those that are staged.
    pub name: &'a str,
    /// Its content, naming the neighbours by their passing names.
    pub bytes: &'a [u8],
    /// The neighbours that are replaced, each with its passing name.
    pub neighbours: &'a [(&'a str, String)],
}

#[derive(Debug)]
struct StagedBridge {
    file: StagedFile,
    /// The files, by their place among the staged ones, and the paths at which they stand for the while.
    passing: Vec<(usize, PathBuf)>,
}

impl Staging {
    /// As [`Self::stage`], to be committed over a bridge.
    ///
    /// # Errors
    /// As [`Self::stage`].
    pub fn stage_bridged<'a>(
        &self,
        folder: &Path,
        files: &[(&'a str, &'a [u8])],
        bridge: &Bridge<'_>,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Staged, AppError> {
        let mut staged = self.stage_watched(folder, files, progress, cancel)?;
        let place = |name: &str| {
            if folder == Path::new(".") {
                PathBuf::from(name)
            } else {
                folder.join(name)
            }
        };
        let name = place(bridge.name);
        let file = self.stage_one(&name, bridge.bytes, &mut |_| Ok(()))?;
        let passing = bridge.neighbours.iter().filter_map(|(name, passing)| {
            let file = files.iter().position(|(other, _)| other == name)?;
            Some((file, place(passing)))
        });
        staged.bridges.push(StagedBridge {
            file,
            passing: passing.collect(),
        });
        Ok(staged)
    }

    /// Writes and syncs `files` beside their targets, under temporary names. The targets are relative to `folder`,
    /// which must be there; folders inside of it are made where they lack.
    ///
    /// # Errors
    /// Where a file can't be written; nothing is left behind then.
    pub fn stage<'a>(
        &self,
        folder: &Path,
        files: impl IntoIterator<Item = (&'a str, &'a [u8])>,
    ) -> Result<Staged, AppError> {
        let files: Vec<_> = files.into_iter().collect();
        self.stage_watched(folder, &files, &Progress::new(), &Cancel::new())
    }

    /// As [`Self::stage`], telling how far it is.
    ///
    /// # Errors
    /// As [`Self::stage`]; [`AppError::Interrupted`] soon after `cancel` is raised, and nothing is left behind then
    /// either.
    pub fn stage_watched(
        &self,
        folder: &Path,
        files: &[(&str, &[u8])],
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Staged, AppError> {
        let all = files.iter().map(|(_, bytes)| bytes.len()).sum::<usize>().max(1) as f64;
        let mut written = 0;
        let mut go_on = |bytes: usize| {
            written += bytes;
            progress.set((written as f64 / all) as f32);
            cancel.check().map_err(|_| AppError::Interrupted)
        };
        let mut staged = Staged {
            files: Vec::new(),
            bridges: Vec::new(),
            folders: Vec::new(),
            staging: self.clone(),
        };
        for &(name, bytes) in files {
            let name = if folder == Path::new(".") {
                PathBuf::from(name)
            } else {
                folder.join(name)
            };
            staged
                .make_folders(folder, &name)
                .map_err(|error| FileError::writing(&name, error))?;
            staged.files.push(self.stage_one(&name, bytes, &mut go_on)?);
        }
        Ok(staged)
    }

    /// Takes away what is staged and not committed, and keeps anything from being staged or committed for as long as
    /// the guard lives. `None` when a commit is done already and its files are to stay.
    pub fn discard(&self) -> Option<Discarded<'_>> {
        let mut state = self.lock();
        if state.committed {
            return None;
        }
        for path in state.temporary.drain(..) {
            // What can't be removed was removed already.
            let _ = fs::remove_file(path);
        }
        Some(Discarded { _state: state })
    }

    /// Writes and syncs one file. `go_on` is told of the bytes that are written, and may end it.
    fn stage_one(
        &self,
        name: &Path,
        bytes: &[u8],
        go_on: &mut dyn FnMut(usize) -> Result<(), AppError>,
    ) -> Result<StagedFile, AppError> {
        let refuse = |error| FileError::writing(name, error);
        // Replacing a link would leave the file that it names as it was.
        let target = fs::canonicalize(name).unwrap_or_else(|_| name.to_owned());
        let existing = fs::metadata(&target).ok();
        if let Some(existing) = &existing {
            if existing.is_dir() {
                return Err(refuse(ErrorKind::IsADirectory.into()).into());
            }
            // Renaming would replace it all the same; whoever took the right to write meant it.
            if existing.permissions().readonly() {
                return Err(refuse(ErrorKind::PermissionDenied.into()).into());
            }
        }
        let mut temporary = self.temporary_beside(&target).map_err(refuse)?;
        go_on(0)?;
        for lasting in bytes.chunks(LASTING) {
            for block in lasting.chunks(BLOCK) {
                temporary.write_all(block).map_err(refuse)?;
                go_on(block.len())?;
            }
            temporary.as_file().sync_data().map_err(refuse)?;
            go_on(0)?;
        }
        if let Some(existing) = &existing {
            temporary
                .as_file()
                .set_permissions(existing.permissions())
                .map_err(refuse)?;
        }
        temporary.as_file().sync_all().map_err(refuse)?;
        Ok(StagedFile {
            name: name.to_owned(),
            target,
            temporary: temporary.into_temp_path(),
        })
    }

    fn temporary_beside(&self, target: &Path) -> io::Result<NamedTempFile> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".pliant-").suffix(".tmp");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As any new file: everybody, less what the umask takes. tempfile's own default is the owner alone.
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        let mut state = self.lock();
        let temporary = builder.tempfile_in(folder_of(target))?;
        state.temporary.push(temporary.path().to_owned());
        Ok(temporary)
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Nothing is staged or committed for as long as this lives.
#[derive(Debug)]
pub struct Discarded<'a> {
    _state: MutexGuard<'a, State>,
}

impl Staged {
    /// Adds the files of `other`, to be committed after these.
    pub fn and(mut self, mut other: Self) -> Self {
        let before = self.files.len();
        for bridge in &mut other.bridges {
            bridge.passing.iter_mut().for_each(|(file, _)| *file += before);
        }
        self.bridges.append(&mut other.bridges);
        self.files.append(&mut other.files);
        self.folders.append(&mut other.folders);
        self
    }

    /// Makes the folders between `folder` and the file `name` in it.
    fn make_folders(&mut self, folder: &Path, name: &Path) -> io::Result<()> {
        let missing: Vec<&Path> = folder_of(name)
            .ancestors()
            .take_while(|path| *path != folder && !path.exists())
            .collect();
        if !folder.exists() {
            return Err(ErrorKind::NotFound.into());
        }
        for path in missing.into_iter().rev().filter(|path| !path.as_os_str().is_empty()) {
            fs::create_dir(path)?;
            self.folders.push(path.to_owned());
        }
        Ok(())
    }

    /// Renames every file into place, in order, and syncs the folders.
    ///
    /// # Errors
    /// Where a rename fails. The files that were replaced before it are put back.
    pub fn commit(self) -> Result<(), FileError> {
        self.commit_watched(&mut || {})
    }

    /// As [`Self::commit`]; `before_each` is called before each change of what stands in the folders.
    ///
    /// # Errors
    /// As [`Self::commit`].
    pub fn commit_watched(mut self, before_each: &mut dyn FnMut()) -> Result<(), FileError> {
        let staging = self.staging.clone();
        let mut state = staging.lock();
        let mut files = std::mem::take(&mut self.files);
        let mut passing = Passing(Vec::new());
        let mut first = Vec::new();
        for bridge in self.bridges.drain(..) {
            for (file, path) in bridge.passing {
                before_each();
                let temporary = &files[file].temporary;
                second_name(temporary, &path).map_err(|error| FileError::writing(&path, error))?;
                passing.0.push(path);
            }
            first.push(bridge.file);
        }
        files.splice(0..0, first);
        let mut replaced: Vec<(PathBuf, Option<TempPath>)> = Vec::new();
        let last = files.len().saturating_sub(1);
        for (i, file) in files.into_iter().enumerate() {
            before_each();
            // The last rename is the one that no other can fail after: it needs no way back.
            let backup = if i == last { Ok(None) } else { backup(&file.target) };
            let renamed = backup.and_then(|backup| {
                file.temporary.persist(&file.target).map_err(|error| error.error)?;
                Ok(backup)
            });
            match renamed {
                Ok(backup) => {
                    // The next rename must not last without this one.
                    sync_folder(folder_of(&file.target));
                    replaced.push((file.target, backup));
                }
                Err(error) => {
                    put_back(replaced);
                    return Err(FileError::writing(&file.name, error));
                }
            }
        }
        before_each();
        drop(passing);
        self.folders.clear();
        state.temporary.clear();
        state.committed = true;
        Ok(())
    }
}

/// Files under passing names, which go when this does.
struct Passing(Vec<PathBuf>);

impl Drop for Passing {
    fn drop(&mut self) {
        for path in &self.0 {
            // One that can't be removed is a file too many, and no harm.
            let _ = fs::remove_file(path);
        }
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        self.files.clear();
        for folder in self.folders.drain(..).rev() {
            // One that somebody has put something into stays.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// A second name for the file at `target`, if there is one.
fn backup(target: &Path) -> io::Result<Option<TempPath>> {
    if !target.exists() {
        return Ok(None);
    }
    let name = tempfile::Builder::new()
        .prefix(".pliant-")
        .suffix(".old")
        .make_in(folder_of(target), |path| second_name(target, path))?;
    Ok(Some(name.into_temp_path()))
}

/// Lets the bytes of `file` stand at `path` as well.
fn second_name(file: &Path, path: &Path) -> io::Result<()> {
    // Not every file system has hard links, and an earlier save that was cut off may have left one.
    fs::hard_link(file, path).or_else(|_| fs::copy(file, path).map(|_| ()))
}

fn put_back(replaced: Vec<(PathBuf, Option<TempPath>)>) {
    for (target, backup) in replaced.into_iter().rev() {
        // The error that led here is the one to tell; a second one has no better remedy.
        let _ = match backup {
            Some(backup) => backup.persist(&target).map_err(|error| error.error),
            None => fs::remove_file(&target),
        };
    }
}

/// Makes a rename last through a power cut. Not every system can open a folder for that, and the files are whole
/// either way.
fn sync_folder(folder: &Path) {
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}
