//! Saves several files at once, so that in the end either all of them are written or none is changed.
//!
//! There are two steps. [`Staging::stage`] writes every file's bytes under a temporary name beside its target, with the
//! attributes of the file that it replaces, and syncs them: a lack of space or rights shows here. [`Staged::commit`]
//! then renames them into place, one after the other, and restores the replaced files if a rename fails.
//!
//! The power may fail between two renames. A file that names others must then still have the neighbours with which it
//! was written. So a [`Bridge`] is a version of the file that names its neighbours by passing names, under which their
//! bytes are available during the commit. It is renamed into place first, then the neighbours, then the file itself. At
//! every moment the folder has the old state or the new one, whole, and leftovers can be recognised by their names.

mod commit;

use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use pliant_mesh::{Cancel, Progress};
use tempfile::{NamedTempFile, TempPath};

use super::attributes::{self, OtherNames};
use super::leftovers::{self, PREFIX, TEMPORARY};
use super::lock::{FolderLock, Share};
use super::{Destination, Stamp};
use crate::EngineError;
use crate::file_error::FileError;
use crate::path_text::shown;

/// The number of bytes written between two checks whether the save was cancelled.
const BLOCK: usize = 1 << 22;

/// The number of bytes between two syncs. Without syncs the progress bar would stay at its end until the system has
/// written its cache to the disk.
const LASTING: usize = 1 << 26;

/// The temporary files and locks of a running save, so that an interrupt can remove them. Cloning shares them.
#[derive(Clone, Debug)]
pub struct Staging(Arc<Mutex<State>>);

/// The running saves of this process: the window has several at once, each on its own thread.
static UNDER_WAY: UnderWay = UnderWay(Mutex::new(Vec::new()));

#[derive(Debug, Default)]
struct UnderWay(Mutex<Vec<Weak<Mutex<State>>>>);

#[derive(Debug, Default)]
struct State {
    temporary: Vec<PathBuf>,
    /// Folders that were made for the files.
    folders: Vec<PathBuf>,
    locks: Vec<Weak<FolderLock>>,
    committed: bool,
    readers: Readers,
}

/// The readers of the new files.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
enum Readers {
    /// The readers of the replaced file; for new files the system's default.
    #[default]
    AsUsual,
    /// Only their owner.
    Owner,
}

/// A file to write.
#[derive(Clone, Debug)]
pub struct NewFile<'a> {
    /// Its place.
    pub to: Destination,
    /// Its content.
    pub bytes: &'a [u8],
}

/// Folders that stay locked for as long as this lives.
#[derive(Clone, Debug, Default)]
pub struct Held(Vec<Arc<FolderLock>>);

/// Files that are written and synced under temporary names; dropping this removes them.
#[derive(Debug)]
pub struct Staged {
    files: Vec<StagedFile>,
    bridges: Vec<StagedBridge>,
    staging: Staging,
    /// Dropped last.
    held: Held,
}

#[derive(Debug)]
struct StagedFile {
    to: Destination,
    temporary: TempPath,
    other_names: OtherNames,
}

/// The version of a file that replaces it while its neighbours are being replaced.
#[derive(Clone, Debug)]
pub struct Bridge<'a> {
    /// The file, by its place among the staged ones.
    pub file: usize,
    /// Its content, naming the neighbours by their passing names.
    pub bytes: &'a [u8],
    /// The written neighbours, by their places among the staged ones, and their passing names in the file's folder.
    pub neighbours: Vec<(usize, String)>,
}

#[derive(Debug)]
struct StagedBridge {
    file: StagedFile,
    /// The files, by their place among the staged ones, and their temporary paths.
    passing: Vec<(usize, PathBuf)>,
}

impl UnderWay {
    fn new_staging(&self) -> Staging {
        let staging = Staging(Arc::default());
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain(|state| state.strong_count() > 0);
        all.push(Arc::downgrade(&staging.0));
        staging
    }

    fn discard_others(&self, own: &Staging) {
        let others: Vec<Staging> = {
            let all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            all.iter().filter_map(Weak::upgrade).map(Staging).collect()
        };
        for staging in others.into_iter().filter(|staging| !Arc::ptr_eq(&staging.0, &own.0)) {
            // These stay locked until the process has ended.
            let staging: &'static Staging = Box::leak(Box::new(staging));
            std::mem::forget(staging.discard());
        }
    }
}

impl Default for Staging {
    fn default() -> Self {
        UNDER_WAY.new_staging()
    }
}

impl Staging {
    /// Only their owner may read files staged here, even if they replace another file.
    pub fn private() -> Self {
        let staging = Self::default();
        staging.lock().readers = Readers::Owner;
        staging
    }

    /// Locks folders for writing, after waiting for other saves there, and removes leftovers of killed saves. All
    /// folders of a save must be locked in one call, so that two saves can't wait for each other.
    ///
    /// # Errors
    /// A folder can't be written; [`EngineError::Interrupted`] when `cancel` is raised.
    pub fn hold<'a>(
        &self,
        folders: impl IntoIterator<Item = (&'a Destination, Share)>,
        cancel: &Cancel,
    ) -> Result<Held, EngineError> {
        let mut wanted: Vec<(&Destination, Share)> = folders.into_iter().collect();
        // The order is the same for all saves, and each folder gets the stricter request.
        wanted.sort_by(|(a, of_a), (b, of_b)| a.home.cmp(&b.home).then(of_b.cmp(of_a)));
        wanted.dedup_by(|(a, _), (b, _)| a.home == b.home);
        let mut held = Held::default();
        for (to, share) in wanted {
            let known = self
                .lock()
                .locks
                .iter()
                .filter_map(Weak::upgrade)
                .find(|lock| lock.folder == to.home);
            if let Some(known) = known.filter(|known| known.share >= share) {
                held.0.push(known);
                continue;
            }
            let lock = FolderLock::take(&to.home, share, cancel, leftovers::clear).map_err(|error| {
                if error.kind() == ErrorKind::Interrupted {
                    EngineError::Interrupted
                } else {
                    FileError::writing(&to.given, error).into()
                }
            })?;
            let lock = Arc::new(lock);
            self.lock().locks.push(Arc::downgrade(&lock));
            held.0.push(lock);
        }
        Ok(held)
    }

    /// Notes an empty folder that was made for the files: an interrupt removes it too.
    pub(crate) fn note_folder(&self, folder: &Path) {
        self.lock().folders.push(folder.to_owned());
    }

    /// Writes and syncs `files` beside their targets, under temporary names.
    ///
    /// # Errors
    /// A file can't be written; nothing is left behind then.
    pub fn stage<'a>(&self, files: impl IntoIterator<Item = (PathBuf, &'a [u8])>) -> Result<Staged, EngineError> {
        let to = |(path, bytes): (PathBuf, &'a [u8])| {
            Ok(NewFile {
                to: Destination::of(&path)?,
                bytes,
            })
        };
        let files = files.into_iter().map(to).collect::<Result<Vec<_>, FileError>>()?;
        self.stage_watched(&files, None, &Progress::new(), &Cancel::new())
    }

    /// Like [`Self::stage`], with progress. With a bridge, the files are committed over it.
    ///
    /// # Errors
    /// Those of [`Self::stage`]; [`EngineError::Interrupted`] soon after `cancel` is raised, and nothing is left behind
    /// then either.
    pub fn stage_watched(
        &self,
        files: &[NewFile<'_>],
        bridge: Option<&Bridge<'_>>,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Staged, EngineError> {
        let all = files.iter().map(|file| file.bytes.len()).sum::<usize>().max(1) as f64;
        let mut written = 0;
        let mut go_on = |bytes: usize| {
            written += bytes;
            progress.set((written as f64 / all) as f32);
            cancel.check().map_err(|_| EngineError::Interrupted)
        };
        let held = self.hold(files.iter().map(|file| (&file.to, Share::Together)), cancel)?;
        let mut staged = Staged {
            files: Vec::new(),
            bridges: Vec::new(),
            held,
            staging: self.clone(),
        };
        for file in files {
            staged.files.push(self.stage_one(file, &mut go_on)?);
        }
        if let Some(bridge) = bridge {
            let to = &files[bridge.file].to;
            let file = self.stage_one(
                &NewFile {
                    to: to.clone(),
                    bytes: bridge.bytes,
                },
                &mut |_| Ok(()),
            )?;
            let passing = bridge.neighbours.iter();
            staged.bridges.push(StagedBridge {
                file,
                passing: passing.map(|(file, name)| (*file, to.home.join(name))).collect(),
            });
        }
        Ok(staged)
    }

    /// Removes staged files that are not committed, and prevents further staging and commits as long as the guard
    /// lives. `None` if a commit is already done and its files must stay.
    pub fn discard(&self) -> Option<Discarded<'_>> {
        let mut state = self.lock();
        if state.committed {
            return None;
        }
        for path in state.temporary.drain(..) {
            // A file that can't be removed was removed already.
            let _ = fs::remove_file(path);
        }
        state
            .locks
            .drain(..)
            .filter_map(|lock| lock.upgrade())
            .for_each(|lock| lock.remove_file());
        for folder in state.folders.drain(..) {
            // A folder with somebody's files stays.
            let _ = fs::remove_dir(folder);
        }
        Some(Discarded { _state: state })
    }

    /// Removes the staged, uncommitted files of every other save of this process, and stops those saves: for the end of
    /// the process.
    pub fn discard_others(&self) {
        UNDER_WAY.discard_others(self);
    }

    /// Writes and syncs one file. `go_on` gets the number of written bytes, and may stop the writing.
    fn stage_one(
        &self,
        file: &NewFile<'_>,
        go_on: &mut dyn FnMut(usize) -> Result<(), EngineError>,
    ) -> Result<StagedFile, EngineError> {
        let NewFile { to, bytes } = file;
        self.stage_written(to, |temporary| {
            let refuse = |error| EngineError::from(FileError::writing(&to.given, error));
            go_on(0)?;
            for lasting in bytes.chunks(LASTING) {
                for block in lasting.chunks(BLOCK) {
                    temporary.write_all(block).map_err(refuse)?;
                    go_on(block.len())?;
                }
                temporary.sync_data().map_err(refuse)?;
                go_on(0)?;
            }
            Ok(())
        })
    }

    /// Writes and syncs one file piece by piece: `write` writes all of it.
    ///
    /// # Errors
    /// Those of `write`, and a file that can't be written; nothing is left behind then.
    pub(crate) fn stage_pieces(
        &self,
        to: &Destination,
        cancel: &Cancel,
        write: impl FnOnce(&mut File) -> Result<(), EngineError>,
    ) -> Result<Staged, EngineError> {
        let held = self.hold([(to, Share::Together)], cancel)?;
        Ok(Staged {
            files: vec![self.stage_written(to, write)?],
            bridges: Vec::new(),
            held,
            staging: self.clone(),
        })
    }

    /// Makes a temporary file with the attributes of the one that it replaces, lets `write` write it, and syncs it.
    fn stage_written(
        &self,
        to: &Destination,
        write: impl FnOnce(&mut File) -> Result<(), EngineError>,
    ) -> Result<StagedFile, EngineError> {
        let refuse = |error| FileError::writing(&to.given, error);
        let existing = to.existing()?;
        // A new neighbour is as private as the file that names it.
        let namer = to.namer.as_deref().filter(|_| existing.is_none());
        let like = namer.and_then(|namer| Some((fs::metadata(namer).ok()?, namer)));
        let like = existing.map(|existing| (existing, &*to.target)).or(like);
        // A file that replaces another has no more rights than that one from its first byte on. Other files get the
        // rights of any new file: everybody's, less the umask.
        let mut temporary = self.temporary_in(&to.home, like.is_some()).map_err(refuse)?;
        write(temporary.as_file_mut())?;
        let mut other_names = OtherNames::default();
        if let Some((existing, at)) = &like {
            attributes::hand_on(temporary.as_file(), existing, at).map_err(refuse)?;
            if *at == to.target {
                other_names = attributes::other_names(existing, at);
            }
        }
        if self.lock().readers == Readers::Owner {
            attributes::make_private(temporary.as_file()).map_err(refuse)?;
        }
        temporary.as_file().sync_all().map_err(refuse)?;
        Ok(StagedFile {
            to: to.clone(),
            temporary: temporary.into_temp_path(),
            other_names,
        })
    }

    fn temporary_in(&self, folder: &Path, is_private: bool) -> io::Result<NamedTempFile> {
        let mut state = self.lock();
        let is_private = is_private || state.readers == Readers::Owner;
        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX).suffix(TEMPORARY);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(fs::Permissions::from_mode(if is_private { 0o600 } else { 0o666 }));
        }
        #[cfg(not(unix))]
        let _ = is_private;
        let temporary = builder.tempfile_in(folder)?;
        state.temporary.push(temporary.path().to_owned());
        Ok(temporary)
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A guard: nothing is staged or committed while it lives.
#[derive(Debug)]
pub struct Discarded<'a> {
    _state: MutexGuard<'a, State>,
}

impl Staged {
    /// Adds the files of `other`, for a commit after these.
    pub fn and(mut self, mut other: Self) -> Self {
        let before = self.files.len();
        for bridge in &mut other.bridges {
            bridge.passing.iter_mut().for_each(|(file, _)| *file += before);
        }
        self.bridges.append(&mut other.bridges);
        self.files.append(&mut other.files);
        self.held.0.append(&mut other.held.0);
        self
    }

    /// Keeps folders locked until the commit.
    pub fn holding(mut self, mut held: Held) -> Self {
        self.held.0.append(&mut held.0);
        self
    }

    /// The temporary place of a file's bytes, by its place among the staged files.
    pub fn temporary(&self, file: usize) -> &Path {
        &self.files[file].temporary
    }

    /// The places of the files, in the order of writing.
    pub fn targets(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(|file| &*file.to.target)
    }

    /// Each file's place, and its stamp: a rename keeps length, time and identity.
    ///
    /// # Errors
    /// The system's error.
    pub fn stamps(&self) -> Result<Vec<(PathBuf, Stamp)>, FileError> {
        let files = self.files.iter();
        let stamps = files.map(|file| Ok((file.to.target.clone(), Stamp::of(&file.temporary)?)));
        stamps.collect()
    }

    /// Sentences about properties of the replaced files that can't be kept.
    pub fn notes(&self) -> Vec<String> {
        let with_more = self.files.iter().filter(|file| file.other_names.elsewhere > 0);
        let note = |file: &StagedFile| {
            let count = file.other_names.elsewhere;
            let names = if count == 1 {
                "1 other name".to_owned()
            } else {
                format!("{count} other names")
            };
            format!(
                "{} has {names} in other folders (hard links), which keep the old content: link them again.",
                shown(&file.to.given)
            )
        };
        with_more.map(note).collect()
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        // This must happen before the folders are unlocked: their temporary files are ours only while we hold them.
        self.files.clear();
        self.bridges.clear();
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use std::fs;

    use super::UnderWay;

    #[test]
    fn at_the_process_s_end_every_save_loses_its_temporary_files_and_goes_no_further() {
        let folder = tempfile::tempdir().unwrap();
        let under_way = UnderWay::default();
        let [own, waiting, done] = [(); 3].map(|()| under_way.new_staging());
        let staged = waiting.stage([(folder.path().join("waiting"), &b"new"[..])]).unwrap();
        done.stage([(folder.path().join("done"), &b"new"[..])])
            .unwrap()
            .commit()
            .unwrap();
        assert!(staged.temporary(0).exists());
        under_way.discard_others(&own);
        let left: Vec<_> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect();
        assert_eq!(left, ["done"]);
        // Neither a commit nor another temporary file can get its lock now.
        assert!(waiting.0.try_lock().is_err());
        assert!(own.0.try_lock().is_ok() && done.0.try_lock().is_ok());
    }
}
