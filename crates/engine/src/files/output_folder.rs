//! A folder for the files of a run: made if it is missing, and removed again if the run fails.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use super::{Destination, Staging};
use crate::EngineError;
use crate::file_error::{FileError, in_words};
use crate::path_text::{folder_of, shown};

/// The folder to write.
#[derive(Debug)]
pub(crate) struct OutputFolder {
    /// As the person gave it.
    given: PathBuf,
    exists: bool,
}

/// A folder that was made for a run; dropping this removes it, unless files were put there.
#[derive(Debug)]
pub(crate) struct MadeFolder(Option<PathBuf>);

impl OutputFolder {
    /// Checks the path of a folder to write. `input` is the folder that is read, with its argument's name: the two must
    /// not be in each other.
    ///
    /// # Errors
    /// Something else than a folder at the path, no folder for it to be in, or a place in or around `input`.
    pub fn of(given: &Path, (role, input): (&str, &Path)) -> Result<Self, EngineError> {
        let refuse = |error| EngineError::from(FileError::writing(given, error));
        let exists = given.exists();
        if exists && !given.is_dir() {
            return Err(refuse(in_words("it is a file; give a folder for the frames")));
        }
        let whole = match exists {
            true => fs::canonicalize(given).map_err(refuse)?,
            false => {
                let parent = fs::canonicalize(folder_of(given)).map_err(refuse)?;
                parent.join(given.file_name().unwrap_or_default())
            }
        };
        let input_whole = fs::canonicalize(input).map_err(|error| FileError::reading(input, error))?;
        if whole.starts_with(&input_whole) {
            return Err(EngineError::Arguments(format!(
                "--output {} is in {role} {}, whose frames are read: give a folder outside of it",
                shown(given),
                shown(input)
            )));
        }
        Ok(Self {
            given: given.to_owned(),
            exists,
        })
    }

    /// Makes the folder if it is missing.
    ///
    /// # Errors
    /// The system's.
    pub fn make(&self, staging: &Staging) -> Result<MadeFolder, EngineError> {
        if self.exists {
            return Ok(MadeFolder(None));
        }
        let refuse = |error| EngineError::from(FileError::writing(&self.given, error));
        fs::create_dir(&self.given).map_err(refuse)?;
        let made = MadeFolder(Some(self.given.clone()));
        staging.note_folder(&fs::canonicalize(&self.given).map_err(refuse)?);
        Ok(made)
    }

    /// The place of a file in the folder, which must exist.
    ///
    /// # Errors
    /// Those of [`Destination::of`].
    pub fn inside(&self, name: impl AsRef<OsStr>) -> Result<Destination, FileError> {
        Destination::of(&self.given.join(name.as_ref()))
    }
}

impl MadeFolder {
    /// Keeps the folder.
    pub fn keep(mut self) {
        self.0 = None;
    }
}

impl Drop for MadeFolder {
    fn drop(&mut self) {
        if let Some(folder) = self.0.take() {
            // A folder with somebody's files stays.
            let _ = fs::remove_dir(folder);
        }
    }
}
