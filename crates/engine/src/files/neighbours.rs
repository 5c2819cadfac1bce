//! A file's neighbours on disk: files that a glTF or an OBJ names by a path relative to its own folder.
//!
//! A file from a stranger may name anything. Only ordinary files at relative paths are read, each once for all of its
//! spellings, and together no more than a budget allows.

use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Read as _};
use std::path::{Path, PathBuf};

use pliant_io::{Bytes, Resolver};

use super::follow;
use super::stamp::Stamp;
use crate::file_error::{in_words, reason};
use crate::path_text::{folder_of, neighbour_path};

/// The limit of all neighbours of a file, unless the caller gives another: 16 GiB, several times the size of the
/// largest scans.
pub const NEIGHBOUR_BYTES: u64 = 16 << 30;

/// The neighbours of one file; those that were read are shared by all that name them.
#[derive(Debug)]
pub struct Neighbours {
    folder: PathBuf,
    /// The place to which a link leads: a save through the link writes the neighbours there.
    folder_behind: Option<PathBuf>,
    budget: u64,
    known: RefCell<Known>,
}

/// The files read so far.
#[derive(Debug, Default)]
struct Known {
    by_path: HashMap<String, Bytes>,
    /// The bytes by the place on disk, to which several paths may lead.
    by_place: HashMap<PathBuf, (Bytes, fs::Metadata)>,
    /// The places on disk that the file names without a need for their bytes.
    unread: BTreeSet<PathBuf>,
    bytes: u64,
}

impl Neighbours {
    /// The neighbours of `file`.
    pub fn of(file: &Path) -> Self {
        let is_link = fs::symlink_metadata(file).is_ok_and(|metadata| metadata.is_symlink());
        let behind = is_link.then(|| follow(file).ok()).flatten();
        Self {
            folder: folder_of(file).to_owned(),
            folder_behind: behind.map(|target| folder_of(&target).to_owned()),
            budget: NEIGHBOUR_BYTES,
            known: RefCell::default(),
        }
    }

    /// The same with at most this many bytes in all.
    #[must_use]
    pub fn within(self, budget: u64) -> Self {
        Self { budget, ..self }
    }

    /// The places on disk of the neighbours that the file named so far, read or not.
    pub fn places(&self) -> Vec<PathBuf> {
        let known = self.known.borrow();
        known.by_place.keys().chain(&known.unread).cloned().collect()
    }

    /// The places on disk of the neighbours read so far, sorted, each with its stamp.
    pub fn were_read(&self) -> Vec<(PathBuf, Stamp)> {
        let known = self.known.borrow();
        let places = known.by_place.iter();
        let stamped = |(place, (bytes, metadata)): (&PathBuf, &(Bytes, fs::Metadata))| {
            (place.clone(), Stamp::of_bytes(place, metadata, bytes))
        };
        let mut places: Vec<_> = places.map(stamped).collect();
        places.sort_by(|(a, _), (b, _)| a.cmp(b));
        places
    }

    /// If both folders have one, the one that a save through the link writes counts.
    fn read_once(&self, path: &str) -> io::Result<Bytes> {
        let behind = self.folder_behind.as_deref().map(|folder| self.read_in(folder, path));
        match behind {
            Some(Err(error)) if error.kind() == ErrorKind::NotFound => self.read_in(&self.folder, path),
            Some(bytes) => bytes,
            None => self.read_in(&self.folder, path),
        }
    }

    fn read_in(&self, folder: &Path, path: &str) -> io::Result<Bytes> {
        let full = neighbour_path(folder, path);
        // A file's type is checked before it is opened: opening a pipe or a device may block, or have an effect.
        refuse_strange(&fs::metadata(&full)?)?;
        let place = fs::canonicalize(&full)?;
        let mut known = self.known.borrow_mut();
        if let Some((bytes, _)) = known.by_place.get(&place) {
            return Ok(bytes.clone());
        }
        let (bytes, metadata) = self.read_ordinary(&full, self.budget.saturating_sub(known.bytes))?;
        known.bytes += bytes.len() as u64;
        let bytes = Bytes::from(bytes);
        known.by_place.insert(place, (bytes.clone(), metadata));
        Ok(bytes)
    }

    /// The bytes of an ordinary file if there are at most `left` of them.
    fn read_ordinary(&self, path: &Path, left: u64) -> io::Result<(Vec<u8>, fs::Metadata)> {
        let file = open(path)?;
        let metadata = file.metadata()?;
        // It may be another file than a moment ago.
        refuse_strange(&metadata)?;
        let too_large = || {
            let budget = self.budget as f64 / f64::from(1 << 30);
            in_words(format!(
                "with it, the files that this file names exceed {budget} GiB in all; use smaller files"
            ))
        };
        if metadata.len() > left {
            return Err(too_large());
        }
        let mut bytes = Vec::new();
        bytes
            .try_reserve_exact(metadata.len() as usize)
            .map_err(|_| ErrorKind::OutOfMemory)?;
        // A file may have more bytes than its reported size.
        file.take(left.saturating_add(1)).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > left {
            return Err(too_large());
        }
        Ok((bytes, metadata))
    }
}

impl Resolver for Neighbours {
    fn read(&self, uri: &str) -> Result<Bytes, String> {
        let path = relative(uri)?;
        if let Some(bytes) = self.known.borrow().by_path.get(&path) {
            return Ok(bytes.clone());
        }
        let bytes = self.read_once(&path).map_err(|error| reason(&error))?;
        self.known.borrow_mut().by_path.insert(path, bytes.clone());
        Ok(bytes)
    }

    fn note_unread(&self, uri: &str) -> bool {
        let Ok(path) = relative(uri) else {
            return false;
        };
        let folders = self.folder_behind.iter().chain([&self.folder]);
        let places = folders.filter_map(|folder| fs::canonicalize(neighbour_path(folder, &path)).ok());
        let places: Vec<PathBuf> = places.filter(|place| place.is_file()).collect();
        let exists = !places.is_empty();
        self.known.borrow_mut().unread.extend(places);
        exists
    }
}

/// A path in its shortest form, so that all spellings of it are equal, or a sentence that says why it is not followed.
fn relative(uri: &str) -> Result<String, String> {
    if uri.contains("://") {
        return Err("it is an address, not a path; download it and name it by its path".to_owned());
    }
    let is_drive = uri.as_bytes().get(1) == Some(&b':') && uri.as_bytes()[0].is_ascii_alphabetic();
    if is_drive || uri.starts_with(['/', '\\']) {
        return Err(
            "it is an absolute path, but only relative paths are read; name it relative to this file".to_owned(),
        );
    }
    let mut steps: Vec<&str> = Vec::new();
    for step in uri.split(|letter| letter == '/' || cfg!(windows) && letter == '\\') {
        match step {
            "" | "." => {}
            ".." if steps.last().is_some_and(|last| *last != "..") => {
                steps.pop();
            }
            step if is_reserved(step) => return Err(format!("{step} is not a valid file name on this system")),
            step => steps.push(step),
        }
    }
    if steps.is_empty() {
        return Err("it names no file".to_owned());
    }
    Ok(steps.join("/"))
}

/// Returns true if a name is a device, or a stream within a file, on Windows.
fn is_reserved(step: &str) -> bool {
    if !cfg!(windows) {
        return false;
    }
    let stem = step.split('.').next().unwrap_or(step).trim_end().to_ascii_uppercase();
    let is_port = |name: &str| {
        let number = stem.strip_prefix(name).map(|rest| rest.chars().collect::<Vec<_>>());
        number.is_some_and(|rest| matches!(rest[..], ['0'..='9' | '¹' | '²' | '³']))
    };
    step.contains(':')
        || ["CON", "PRN", "AUX", "NUL", "CONIN$", "CONOUT$"].contains(&&*stem)
        || is_port("COM")
        || is_port("LPT")
}

fn refuse_strange(metadata: &fs::Metadata) -> io::Result<()> {
    match metadata {
        _ if metadata.is_dir() => Err(ErrorKind::IsADirectory.into()),
        _ if !metadata.is_file() => Err(in_words("it is not an ordinary file; give the path of one")),
        _ => Ok(()),
    }
}

/// Opens a file without blocking, in case it has become a pipe since it was checked.
fn open(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt as _;
        options.custom_flags(rustix::fs::OFlags::NONBLOCK.bits().cast_signed());
    }
    options.open(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_spellings_of_a_path_are_one() {
        for uri in ["a.bin", "./a.bin", "b/../a.bin", ".//./a.bin", "b/c/../../a.bin"] {
            assert_eq!(relative(uri).as_deref(), Ok("a.bin"), "{uri}");
        }
        assert_eq!(relative("b/../../x/./a.bin").as_deref(), Ok("../x/a.bin"));
        assert_eq!(relative("../../a").as_deref(), Ok("../../a"));
    }

    #[test]
    fn absolute_paths_drives_shares_and_addresses_are_never_followed() {
        for uri in [
            "/etc/passwd",
            "//server/x",
            "\\\\server\\x",
            "\\x",
            "C:\\x",
            "c:x",
            "file:///x",
            "",
            ".",
            "a/..",
        ] {
            assert!(relative(uri).is_err(), "{uri}");
        }
    }
}
