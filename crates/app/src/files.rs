//! Files on disk: reading whole ones, and where a file stands. [`Staging`] writes them.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use pliant_io::Placement;

pub use crate::staging::{Bridge, Staged, Staging};

/// A file could not be read or written.
#[derive(Debug, thiserror::Error)]
#[error("{} can't be {verb}: {}", .file.display(), reason(.source))]
pub struct FileError {
    file: PathBuf,
    verb: &'static str,
    source: io::Error,
}

impl FileError {
    fn reading(file: &Path, source: io::Error) -> Self {
        Self {
            file: file.to_owned(),
            verb: "read",
            source,
        }
    }

    pub(crate) fn writing(file: &Path, source: io::Error) -> Self {
        Self {
            file: file.to_owned(),
            verb: "written",
            source,
        }
    }
}

/// What the system said, with the remedy.
pub(crate) fn reason(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "there is no such file or folder; check the path".to_owned(),
        ErrorKind::PermissionDenied => "permission is denied; check the rights of the file and its folder".to_owned(),
        ErrorKind::IsADirectory => "it is a folder; give the path of a file".to_owned(),
        ErrorKind::NotADirectory => "a part of its path is a file and no folder; check the path".to_owned(),
        ErrorKind::StorageFull => "the disk is full; make room or choose another place".to_owned(),
        ErrorKind::QuotaExceeded => "the disk quota is used up; make room or choose another place".to_owned(),
        ErrorKind::ReadOnlyFilesystem => "its file system is read-only; choose another place".to_owned(),
        ErrorKind::FileTooLarge => "it is larger than its file system allows; choose another place".to_owned(),
        ErrorKind::OutOfMemory => "it does not fit into memory; close other programs or use a smaller file".to_owned(),
        ErrorKind::InvalidData => "it is not UTF-8 text; save it as UTF-8".to_owned(),
        _ => format!("{error}; check the path and the disk").replace(['\n', '\r'], " "),
    }
}

/// Reads a whole file. What is no ordinary file is refused: a pipe would wait for ever.
///
/// # Errors
/// What the system says.
pub fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    let refuse = |error| FileError::reading(path, error);
    let metadata = fs::metadata(path).map_err(refuse)?;
    if metadata.is_dir() {
        return Err(refuse(ErrorKind::IsADirectory.into()));
    }
    if !metadata.is_file() {
        return Err(refuse(io::Error::other("it is no ordinary file")));
    }
    fs::read(path).map_err(refuse)
}

/// Reads a whole text file in UTF-8.
///
/// # Errors
/// What the system says, or that it is no UTF-8.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    let bytes = read(path)?;
    String::from_utf8(bytes).map_err(|_| FileError::reading(path, ErrorKind::InvalidData.into()))
}

/// Where `output` stands as seen from `source`.
pub fn placement(source: &Path, output: &Path) -> Placement {
    let same = |a: &Path, b: &Path| match (fs::canonicalize(a), fs::canonicalize(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    };
    if same(source, output) {
        Placement::SameFile
    } else if same(folder_of(source), folder_of(output)) {
        Placement::SameFolder
    } else {
        Placement::OtherFolder
    }
}

/// The folder that a path stands in, "." for a bare name.
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}
