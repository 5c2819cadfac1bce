//! The place to write a file, through links, and whether it is writable.

use std::ffi::OsStr;
use std::fs::{self, Metadata};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::follow;
use crate::file_error::{FileError, in_words};
use crate::path_text::folder_of;

/// The place to which a path leads, found without opening anything.
#[derive(Clone, Debug)]
pub struct Destination {
    /// The path as the person gave it, for messages.
    pub given: PathBuf,
    /// The file to write: the target of links, with its folder's true spelling. The link itself stays.
    pub target: PathBuf,
    /// The folder in which it is prepared: its own, or for a neighbour that of the file that names it.
    pub home: PathBuf,
    /// For a neighbour, the file that names it: a new neighbour gets that file's rights.
    pub(super) namer: Option<PathBuf>,
}

impl Destination {
    /// Follows `path` like editors do.
    ///
    /// # Errors
    /// If its folder is missing, or if there is a folder, a device, a pipe or a socket, or a file that is not writable.
    pub fn of(path: &Path) -> Result<Self, FileError> {
        let target = follow(path).map_err(|error| FileError::writing(path, error))?;
        let destination = Self {
            given: path.to_owned(),
            home: folder_of(&target).to_owned(),
            target,
            namer: None,
        };
        destination.existing()?;
        Ok(destination)
    }

    /// A neighbour of this file at `target`.
    pub(super) fn neighbour(&self, given: PathBuf, target: PathBuf) -> Self {
        Self {
            given,
            target,
            home: self.home.clone(),
            namer: Some(self.target.clone()),
        }
    }

    /// The file's name, or that of a link's target.
    pub fn name(&self) -> &OsStr {
        self.target.file_name().unwrap_or_default()
    }

    /// The existing file, if there is one; it must be replaceable.
    ///
    /// # Errors
    /// Those of [`Self::of`].
    pub fn existing(&self) -> Result<Option<Metadata>, FileError> {
        let refuse = |error| Err(FileError::writing(&self.given, error));
        let metadata = match fs::metadata(&self.target) {
            Ok(metadata) => metadata,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return refuse(error),
        };
        if metadata.is_dir() {
            return refuse(ErrorKind::IsADirectory.into());
        }
        if !metadata.is_file() {
            return refuse(in_words(
                "a device, a pipe or a socket has this path; choose another place",
            ));
        }
        // A rename would replace it anyway, but a file was made read-only for a reason.
        if metadata.permissions().readonly() {
            return refuse(ErrorKind::PermissionDenied.into());
        }
        Ok(Some(metadata))
    }
}
