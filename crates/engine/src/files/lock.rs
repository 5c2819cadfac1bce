//! A lock on a folder that is written to.
//!
//! It is an advisory lock of the system on a file in that folder. It ends with its process, for every way of ending, so
//! there are no stale locks. A save of several files holds it alone; saves of single files, which are one rename each,
//! share it. While it is held alone no other save is running there, so temporary files in the folder are leftovers.
//!
//! The lock's file is removed by its last holder. One that a killed process left is used by the next save.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use pliant_mesh::Cancel;

use crate::file_error::in_words;

/// The lock's name in its folder.
const NAME: &str = ".pliant.lock";

/// The time that a save waits for another one in the same folder.
const PATIENCE: Duration = Duration::from_secs(120);

/// The sharing of a lock.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Share {
    /// Shared with other saves of single files.
    Together,
    /// Not shared.
    Alone,
}

/// A held lock.
#[derive(Debug)]
pub(super) struct FolderLock {
    pub folder: PathBuf,
    pub share: Share,
    /// `None` if the file system has no locks: then saves continue without one.
    file: Option<File>,
}

impl FolderLock {
    /// Waits for the lock on `folder`. `clear` is called while it is held alone, at least for a moment; it is not
    /// called if the lock can't be held alone at once and `share` doesn't require that.
    ///
    /// # Errors
    /// The system's error; [`ErrorKind::Interrupted`] when `cancel` is raised; a sentence when another save in the
    /// folder does not end.
    pub fn take(folder: &Path, share: Share, cancel: &Cancel, clear: impl FnOnce(&Path)) -> io::Result<Self> {
        let path = folder.join(NAME);
        let start = Instant::now();
        let mut pause = Duration::from_millis(2);
        let mut clear = Some(clear);
        loop {
            let file = open(&path)?;
            let held = match file.try_lock() {
                Ok(()) => {
                    if !is_at(&file, &path) {
                        continue;
                    }
                    if let Some(clear) = clear.take() {
                        clear(folder);
                    }
                    match share {
                        Share::Alone => true,
                        // The change is not atomic: another process may hold it alone in between.
                        Share::Together => file.try_lock_shared().is_ok(),
                    }
                }
                Err(TryLockError::WouldBlock) => share == Share::Together && file.try_lock_shared().is_ok(),
                Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Interrupted => false,
                Err(TryLockError::Error(_)) => {
                    remove(&file, &path);
                    return Ok(Self {
                        folder: folder.to_owned(),
                        share,
                        file: None,
                    });
                }
            };
            if held && is_at(&file, &path) {
                return Ok(Self {
                    folder: folder.to_owned(),
                    share,
                    file: Some(file),
                });
            }
            drop(file);
            if cancel.is_cancelled() {
                return Err(ErrorKind::Interrupted.into());
            }
            if start.elapsed() > PATIENCE {
                return Err(in_words(
                    "another save in its folder is still running; wait for it or stop it, and save again",
                ));
            }
            std::thread::sleep(pause);
            pause = (2 * pause).min(Duration::from_millis(50));
        }
    }

    /// Removes the file unless others hold it too.
    pub fn remove_file(&self) {
        let Some(file) = &self.file else { return };
        let path = self.folder.join(NAME);
        let is_last = self.share == Share::Alone || file.try_lock().is_ok();
        if is_last && is_at(file, &path) {
            remove(file, &path);
        }
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        self.remove_file();
    }
}

/// Opens the lock's file, and makes it if necessary. It is always an ordinary file, never reached through a link.
fn open(path: &Path) -> io::Result<File> {
    let mut last = io::Error::from(ErrorKind::NotFound);
    // Its last holder may remove it between two checks.
    for _ in 0..1000 {
        match fs::symlink_metadata(path) {
            Ok(metadata) if !metadata.is_file() => {
                return Err(in_words(format!(
                    "{NAME} in its folder is not an ordinary file; remove it"
                )));
            }
            Ok(_) => match File::open(path) {
                Err(error) if error.kind() == ErrorKind::NotFound => last = error,
                opened => return opened,
            },
            Err(error) if error.kind() == ErrorKind::NotFound => {
                let mut options = OpenOptions::new();
                options.read(true).write(true).create_new(true);
                match options.open(path) {
                    Err(error) if error.kind() == ErrorKind::AlreadyExists => last = error,
                    opened => {
                        let file = opened?;
                        for_everybody(&file);
                        return Ok(file);
                    }
                }
            }
            Err(error) => return Err(error),
        }
    }
    Err(last)
}

/// Lets other users of a shared folder open the lock, independent of the umask: it is empty.
fn for_everybody(file: &File) {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let _ = file.set_permissions(fs::Permissions::from_mode(0o644));
    }
    #[cfg(not(unix))]
    let _ = file;
}

/// Removes a lock's file. A lock is empty, so a file with content is a person's file of this name, which stays.
fn remove(file: &File, path: &Path) {
    if file.metadata().is_ok_and(|metadata| metadata.len() == 0) {
        // The next save takes over a file that can't be removed.
        let _ = fs::remove_file(path);
    }
}

/// Returns true if the open file is still the one at the path.
fn is_at(file: &File, path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let node = |metadata: io::Result<fs::Metadata>| metadata.map(|found| (found.dev(), found.ino())).ok();
        node(file.metadata()).is_some_and(|held| node(fs::symlink_metadata(path)) == Some(held))
    }
    #[cfg(not(unix))]
    {
        let _ = file;
        path.exists()
    }
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    fn take(folder: &Path, share: Share, cancel: &Cancel) -> io::Result<(FolderLock, bool)> {
        let mut was_alone = false;
        let lock = FolderLock::take(folder, share, cancel, |_| was_alone = true)?;
        Ok((lock, was_alone))
    }

    #[test]
    fn one_alone_or_many_together_and_no_file_in_the_end() {
        let folder = tempfile::tempdir().unwrap();
        let (go_on, stopped) = (Cancel::new(), Cancel::new());
        stopped.cancel();
        // A file left by a killed process is taken over.
        fs::write(folder.path().join(NAME), "").unwrap();
        let (first, was_alone) = take(folder.path(), Share::Together, &go_on).unwrap();
        assert!(was_alone);
        let (second, was_alone) = take(folder.path(), Share::Together, &go_on).unwrap();
        assert!(!was_alone, "the first is still there");
        assert!(take(folder.path(), Share::Alone, &stopped).is_err());
        drop(first);
        assert!(take(folder.path(), Share::Alone, &stopped).is_err());
        drop(second);
        let (alone, was_alone) = take(folder.path(), Share::Alone, &go_on).unwrap();
        assert!(was_alone);
        assert!(take(folder.path(), Share::Together, &stopped).is_err());
        drop(alone);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn who_waits_comes_in_when_the_other_is_done() {
        let folder = tempfile::tempdir().unwrap();
        let inside = std::sync::atomic::AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..25 {
                        let lock = take(folder.path(), Share::Alone, &Cancel::new()).unwrap();
                        assert_eq!(inside.fetch_add(1, std::sync::atomic::Ordering::SeqCst), 0);
                        inside.fetch_sub(1, std::sync::atomic::Ordering::SeqCst);
                        drop(lock);
                    }
                });
            }
        });
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
