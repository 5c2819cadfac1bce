//! Reading whole files.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use super::error::{FileError, in_words};

/// Reads a whole file. Anything but an ordinary file is refused: reading a pipe could block for ever.
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
        return Err(refuse(in_words("it is no ordinary file; give the path of one")));
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
