//! The reason why a file could not be read or written.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use crate::path_text::shown;

/// A file could not be read or written.
#[derive(Debug, thiserror::Error)]
#[error("{} can't be {verb}: {}", shown(.file), reason(.source))]
pub struct FileError {
    file: PathBuf,
    verb: &'static str,
    pub(crate) source: io::Error,
}

impl FileError {
    pub(crate) fn reading(file: &Path, source: io::Error) -> Self {
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

    /// The file that caused the error.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The system's kind of error.
    pub fn kind(&self) -> ErrorKind {
        self.source.kind()
    }

    /// The system's message, with the remedy.
    pub fn reason(&self) -> String {
        reason(&self.source)
    }
}

/// A reason in our own words, with its remedy.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct Words(String);

/// An error whose reason is this sentence.
pub(crate) fn in_words(sentence: impl Into<String>) -> io::Error {
    io::Error::other(Words(sentence.into()))
}

/// The system's message, with the remedy.
pub(crate) fn reason(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "there is no such file or folder; check the path".to_owned(),
        ErrorKind::PermissionDenied => "permission is denied; check the rights of the file and its folder".to_owned(),
        ErrorKind::IsADirectory => "it is a folder; give the path of a file".to_owned(),
        ErrorKind::NotADirectory => "a part of its path is a file, not a folder; check the path".to_owned(),
        ErrorKind::StorageFull => "the disk is full; make room or choose another place".to_owned(),
        ErrorKind::QuotaExceeded => "the disk quota is used up; make room or choose another place".to_owned(),
        ErrorKind::ReadOnlyFilesystem => "its file system is read-only; choose another place".to_owned(),
        ErrorKind::FileTooLarge => "it is larger than its file system allows; choose another place".to_owned(),
        ErrorKind::OutOfMemory => "it does not fit into memory; close other programs or use a smaller file".to_owned(),
        ErrorKind::InvalidData => "it is not UTF-8 text; save it as UTF-8".to_owned(),
        ErrorKind::InvalidFilename => "its name is longer than the system allows; choose a shorter one".to_owned(),
        _ => match error.get_ref().is_some_and(|inner| inner.is::<Words>()) {
            true => error.to_string(),
            false => pliant_io::quoted(&format!("{error}; check the path and the disk")),
        },
    }
}
