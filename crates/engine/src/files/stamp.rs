//! The content of a file when it was read or written, to detect later changes by another program.
//!
//! The content decides, by its digest: a program may write a file without changing its length, or reset its time, and a
//! copy of the same bytes is no change. Only length, time and identity are compared if hashing would take too long.

use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use sha2::{Digest, Sha256};

use super::same_file::{Identity, identity};
use super::{follow, is_same};
use crate::file_error::FileError;

/// The number of bytes hashed at a time.
const BLOCK: usize = 1 << 20;

/// A file at one moment.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Stamp {
    metadata: Marks,
    digest: [u8; 32],
}

/// The properties that show a write without reading the file.
#[derive(Clone, PartialEq, Eq, Debug)]
struct Marks {
    length: u64,
    modified: Option<SystemTime>,
    identity: Option<Identity>,
}

impl Marks {
    fn of(path: &Path, metadata: &Metadata) -> Self {
        Self {
            length: metadata.len(),
            modified: metadata.modified().ok(),
            identity: identity(path),
        }
    }
}

impl Stamp {
    /// The stamp of these bytes, read from the file at `path` after its `metadata`.
    pub(super) fn of_bytes(path: &Path, metadata: &Metadata, bytes: &[u8]) -> Self {
        Self {
            metadata: Marks::of(path, metadata),
            digest: Sha256::digest(bytes).into(),
        }
    }

    /// The stamp of the present file.
    ///
    /// # Errors
    /// The system's error.
    pub fn of(path: &Path) -> Result<Self, FileError> {
        Self::read(path).map_err(|error| FileError::reading(path, error))
    }

    fn read(path: &Path) -> io::Result<Self> {
        let mut file = File::open(path)?;
        let metadata = Marks::of(path, &file.metadata()?);
        let mut hash = Sha256::new();
        let mut block = vec![0; BLOCK];
        loop {
            match file.read(&mut block) {
                Ok(0) => break,
                Ok(count) => hash.update(&block[..count]),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(Self {
            metadata,
            digest: hash.finalize().into(),
        })
    }

    /// Returns true if both have the same content.
    pub fn has_content_of(&self, other: &Self) -> bool {
        self.digest == other.digest
    }

    /// Returns true if the file at `path` has this content now.
    pub fn is_current(&self, path: &Path) -> bool {
        let has_length = fs::metadata(path).is_ok_and(|metadata| metadata.len() == self.metadata.length);
        has_length && Self::read(path).is_ok_and(|now| self.has_content_of(&now))
    }

    /// Returns true if the file at `path` was not written since, judged without reading it.
    pub fn looks_current(&self, path: &Path) -> bool {
        fs::metadata(path).is_ok_and(|metadata| Marks::of(path, &metadata) == self.metadata)
    }
}

/// The files that a session has read or written, in their state at that time. Cloning shares them.
#[derive(Clone, Default, Debug)]
pub struct KnownFiles(Arc<Mutex<Vec<(PathBuf, Stamp)>>>);

impl KnownFiles {
    /// Notes a file that was read or written, replacing its earlier stamp.
    pub fn note(&self, path: &Path, stamp: Stamp) {
        let place = follow(path).unwrap_or_else(|_| path.to_owned());
        let mut files = self.lock();
        files.retain(|(known, _)| !is_same(known, &place));
        files.push((place, stamp));
    }

    /// The stamp of the file to which a path leads.
    pub fn stamp(&self, path: &Path) -> Option<Stamp> {
        let files = self.lock().clone();
        let known = files.into_iter().find(|(known, _)| is_same(known, path));
        known.map(|(_, stamp)| stamp)
    }

    /// Returns true if a file is known and has another content now. A missing one has no content to lose.
    pub fn is_changed(&self, path: &Path) -> bool {
        path.exists() && self.stamp(path).is_some_and(|stamp| !stamp.is_current(path))
    }

    fn lock(&self) -> MutexGuard<'_, Vec<(PathBuf, Stamp)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "tests")]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn a_file_has_changed_if_its_content_has() {
        let folder = tempfile::tempdir().unwrap();
        let [path, other] = ["a", "b"].map(|name| folder.path().join(name));
        fs::write(&path, "first").unwrap();
        let known = KnownFiles::default();
        assert!(!known.is_changed(&path), "nothing is known of it");
        known.note(&path, Stamp::of(&path).unwrap());
        assert!(!known.is_changed(&path));

        // The same length and the same time.
        let modified = fs::metadata(&path).unwrap().modified().unwrap();
        fs::write(&path, "other").unwrap();
        File::options()
            .write(true)
            .open(&path)
            .unwrap()
            .set_modified(modified)
            .unwrap();
        assert!(known.is_changed(&path));
        known.note(&path, Stamp::of(&path).unwrap());
        assert!(!known.is_changed(&path), "the newest counts");

        // Another time and another identity.
        fs::write(&other, "other").unwrap();
        fs::rename(&other, &path).unwrap();
        let later = modified + Duration::from_secs(60);
        File::options()
            .write(true)
            .open(&path)
            .unwrap()
            .set_modified(later)
            .unwrap();
        assert!(!known.is_changed(&path));
        assert!(!known.stamp(&path).unwrap().looks_current(&path));
        fs::remove_file(&path).unwrap();
        assert!(!known.is_changed(&path), "there is nothing to lose");
    }

    #[cfg(unix)]
    #[test]
    fn a_file_is_known_by_every_path_to_it() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("sub")).unwrap();
        fs::write(at("a"), "first").unwrap();
        std::os::unix::fs::symlink("a", at("link")).unwrap();
        let known = KnownFiles::default();
        known.note(&at("link"), Stamp::of(&at("link")).unwrap());
        // Like saves of other programs: a new file is renamed into its place.
        fs::write(at("new"), "other").unwrap();
        fs::rename(at("new"), at("a")).unwrap();
        for name in ["a", "link", "sub/../a"] {
            assert!(known.is_changed(&at(name)), "{name}");
        }
        known.note(&at("sub/../a"), Stamp::of(&at("a")).unwrap());
        assert!(!known.is_changed(&at("link")), "one note a file");
    }
}
