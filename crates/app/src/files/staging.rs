//! Saving several files at once, so that either all of them are there in the end or none was touched.
//!
//! It goes in two steps. [`Staging::stage`] writes every file's bytes under a temporary name beside its target, with
//! the attributes of what it replaces, and syncs them: whatever can fail for want of space or rights fails here.
//! [`Staged::commit`] then renames them into place, one after the other, and puts back what it replaced should a rename
//! fail after all.
//!
//! Between two renames the power may fail. A file that names others must not then stand beside others than it was
//! written with: a [`Bridge`] is such a file that names its neighbours by names of their own, under which their bytes
//! stand for the while. It is renamed into place first, then the neighbours, then the file itself; at every moment what
//! stands there is the old state or the new one, whole, and what is left over can be told by its name.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use pliant_mesh::{Cancel, Progress};
use tempfile::{NamedTempFile, TempPath};

use super::attributes::{self, OtherNames};
use super::leftovers::{self, PREFIX, REPLACED, TEMPORARY};
use super::lock::{FolderLock, Share};
use super::{Destination, FileError, folder_of, shown};
use crate::AppError;

/// Bytes written between two looks at whether they are still wanted.
const BLOCK: usize = 1 << 22;

/// Bytes after which they are made to last: what the system only remembers is not written yet, and the bar would stand
/// at its end for as long as the disk takes.
const LASTING: usize = 1 << 26;

/// The temporary files and locks of a save that is under way, so that an interrupt can take them away. Cloning shares
/// them.
#[derive(Clone, Debug)]
pub struct Staging(Arc<Mutex<State>>);

/// The saves of this process that are under way: the window has several at once, each by a thread of its own.
static UNDER_WAY: UnderWay = UnderWay(Mutex::new(Vec::new()));

#[derive(Debug, Default)]
struct UnderWay(Mutex<Vec<Weak<Mutex<State>>>>);

#[derive(Debug, Default)]
struct State {
    temporary: Vec<PathBuf>,
    locks: Vec<Weak<FolderLock>>,
    committed: bool,
    readers: Readers,
}

/// Who may read the files that are made.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
enum Readers {
    /// Whoever could read what is replaced, and of new files whom the system lets by default.
    #[default]
    AsUsual,
    /// Their owner alone.
    Owner,
}

/// A file to be written.
#[derive(Clone, Debug)]
pub struct NewFile<'a> {
    /// Where.
    pub to: Destination,
    /// Its content.
    pub bytes: &'a [u8],
}

/// Folders that stay locked for as long as this lives.
#[derive(Clone, Debug, Default)]
pub struct Held(Vec<Arc<FolderLock>>);

/// Files that are written and synced under temporary names; dropping them takes them away again.
#[derive(Debug)]
pub struct Staged {
    files: Vec<StagedFile>,
    bridges: Vec<StagedBridge>,
    staging: Staging,
    /// Let go of last.
    held: Held,
}

#[derive(Debug)]
struct StagedFile {
    to: Destination,
    temporary: TempPath,
    other_names: OtherNames,
}

/// What stands in a file's place while its neighbours are replaced.
#[derive(Clone, Debug)]
pub struct Bridge<'a> {
    /// The file, by its place among those that are staged.
    pub file: usize,
    /// Its content, naming the neighbours by their passing names.
    pub bytes: &'a [u8],
    /// The neighbours that are written, by their places among those that are staged, and their passing names in the
    /// file's folder.
    pub neighbours: Vec<(usize, String)>,
}

#[derive(Debug)]
struct StagedBridge {
    file: StagedFile,
    /// The files, by their place among the staged ones, and the paths at which they stand for the while.
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
            // Locked until the process is gone.
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
    /// One whose files only their owner may read, whatever stood there before.
    pub fn private() -> Self {
        let staging = Self::default();
        staging.lock().readers = Readers::Owner;
        staging
    }

    /// Locks folders that are to be written to, after waiting for others who write there, and clears away what killed
    /// saves have left in them. All folders of a save are to be asked for at once, lest two saves wait for each other.
    ///
    /// # Errors
    /// Where a folder can't be written; [`AppError::Interrupted`] when `cancel` is raised.
    pub fn hold<'a>(
        &self,
        folders: impl IntoIterator<Item = (&'a Destination, Share)>,
        cancel: &Cancel,
    ) -> Result<Held, AppError> {
        let mut wanted: Vec<(&Destination, Share)> = folders.into_iter().collect();
        // One order for everybody, and for each folder the stricter wish.
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
                    AppError::Interrupted
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

    /// Writes and syncs `files` beside their targets, under temporary names.
    ///
    /// # Errors
    /// Where a file can't be written; nothing is left behind then.
    pub fn stage<'a>(&self, files: impl IntoIterator<Item = (PathBuf, &'a [u8])>) -> Result<Staged, AppError> {
        let to = |(path, bytes): (PathBuf, &'a [u8])| {
            Ok(NewFile {
                to: Destination::of(&path)?,
                bytes,
            })
        };
        let files = files.into_iter().map(to).collect::<Result<Vec<_>, FileError>>()?;
        self.stage_watched(&files, None, &Progress::new(), &Cancel::new())
    }

    /// As [`Self::stage`], telling how far it is. With a bridge, the files are committed over it.
    ///
    /// # Errors
    /// As [`Self::stage`]; [`AppError::Interrupted`] soon after `cancel` is raised, and nothing is left behind then
    /// either.
    pub fn stage_watched(
        &self,
        files: &[NewFile<'_>],
        bridge: Option<&Bridge<'_>>,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Staged, AppError> {
        let all = files.iter().map(|file| file.bytes.len()).sum::<usize>().max(1) as f64;
        let mut written = 0;
        let mut go_on = |bytes: usize| {
            written += bytes;
            progress.set((written as f64 / all) as f32);
            cancel.check().map_err(|_| AppError::Interrupted)
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
        state
            .locks
            .drain(..)
            .filter_map(|lock| lock.upgrade())
            .for_each(|lock| lock.remove_file());
        Some(Discarded { _state: state })
    }

    /// Takes away what every other save of this process has staged and not committed, and keeps them from going on: for
    /// the process's end.
    pub fn discard_others(&self) {
        UNDER_WAY.discard_others(self);
    }

    /// Writes and syncs one file. `go_on` is told of the bytes that are written, and may end it.
    fn stage_one(
        &self,
        file: &NewFile<'_>,
        go_on: &mut dyn FnMut(usize) -> Result<(), AppError>,
    ) -> Result<StagedFile, AppError> {
        let NewFile { to, bytes } = file;
        let refuse = |error| FileError::writing(&to.given, error);
        let existing = to.existing()?;
        // A neighbour that is new is as private as the file that names it.
        let namer = to.namer.as_deref().filter(|_| existing.is_none());
        let like = namer.and_then(|namer| Some((fs::metadata(namer).ok()?, namer)));
        let like = existing.map(|existing| (existing, &*to.target)).or(like);
        // A file that replaces another has no more rights than that one from its first byte on. Others get what any
        // new file does: everybody's, less what the umask takes.
        let mut temporary = self.temporary_in(&to.home, like.is_some()).map_err(refuse)?;
        go_on(0)?;
        for lasting in bytes.chunks(LASTING) {
            for block in lasting.chunks(BLOCK) {
                temporary.write_all(block).map_err(refuse)?;
                go_on(block.len())?;
            }
            temporary.as_file().sync_data().map_err(refuse)?;
            go_on(0)?;
        }
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
        self.held.0.append(&mut other.held.0);
        self
    }

    /// Keeps folders locked until the commit.
    pub fn holding(mut self, mut held: Held) -> Self {
        self.held.0.append(&mut held.0);
        self
    }

    /// Where the bytes of a file wait, by its place among those that were staged.
    pub fn temporary(&self, file: usize) -> &Path {
        &self.files[file].temporary
    }

    /// Sentences about what can't be kept of the files that are replaced.
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
                "{} has {names} in other folders (hard links), which keep the old content: link them anew.",
                shown(&file.to.given)
            )
        };
        with_more.map(note).collect()
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
                second_name(&files[file].temporary, &path).map_err(|error| FileError::writing(&path, error))?;
                passing.0.push(path);
            }
            // The bridge must not last without what it names.
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
            // The last rename is the one that no other can fail after: it needs no way back.
            let renamed = make_folders(folder_of(&to.target), &mut done.folders)
                .and_then(|()| if i == last { Ok(None) } else { backup(&to) })
                .and_then(|backup| {
                    temporary.persist(&to.target).map_err(|error| error.error)?;
                    Ok(backup)
                });
            match renamed {
                Ok(backup) => {
                    // The next rename must not last without this one.
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
        // Each other name is a step of its own: a name that can't be brought along keeps the old content.
        for (target, name) in std::mem::take(&mut done.other_names) {
            let _ = bring_along(&target, &name);
        }
        drop((passing, done));
        // What a killed save left under passing names was named by what has just been replaced.
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

/// What a commit has changed so far.
#[derive(Default)]
struct Done {
    /// Targets, and what stood there.
    replaced: Vec<(PathBuf, Option<TempPath>)>,
    /// Folders that were made, outer ones first.
    folders: Vec<PathBuf>,
    /// Targets and other names of what stood there.
    other_names: Vec<(PathBuf, PathBuf)>,
}

impl Done {
    fn put_back(self) {
        for (target, backup) in self.replaced.into_iter().rev() {
            // The error that led here is the one to tell; a second one has no better remedy.
            let _ = match backup {
                Some(backup) => backup.persist(&target).map_err(|error| error.error),
                None => fs::remove_file(&target),
            };
        }
        for folder in self.folders.into_iter().rev() {
            // One that somebody has put something into stays.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Makes a folder and those around it, as far as they are missing, and notes which.
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
        // Before the folders are let go of: what lies there is ours as long as we hold them.
        self.files.clear();
        self.bridges.clear();
    }
}

/// A second name for what stands at a destination, if anything does.
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

/// Lets another name of a file that was replaced lead to the new one.
fn bring_along(target: &Path, name: &Path) -> io::Result<()> {
    let temporary = tempfile::Builder::new()
        .prefix(PREFIX)
        .suffix(TEMPORARY)
        .make_in(folder_of(name), |path| fs::hard_link(target, path))?;
    temporary.into_temp_path().persist(name).map_err(|error| error.error)
}

/// Lets the bytes of `file` stand at `path` as well, where nothing may stand yet.
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

/// Makes a rename last through a power cut. Not every system can open a folder for that, and the files are whole
/// either way.
fn sync_folder(folder: &Path) {
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
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
        // Neither a commit nor another temporary file gets its lock any more.
        assert!(waiting.0.try_lock().is_err());
        assert!(own.0.try_lock().is_ok() && done.0.try_lock().is_ok());
    }
}
