//! Reading whole files.

use std::fs::{self, File, Metadata};
use std::io::{ErrorKind, Read};
use std::path::Path;

use super::stamp::Stamp;
use crate::file_error::{FileError, in_words};

/// Reads a whole file. Anything except an ordinary file is refused: reading a pipe could block for ever.
///
/// # Errors
/// The system's error.
pub fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    ordinary(path)?;
    fs::read(path).map_err(|error| FileError::reading(path, error))
}

/// Like [`read`], with the file's stamp.
///
/// # Errors
/// Those of [`read`].
pub fn read_stamped(path: &Path) -> Result<(Vec<u8>, Stamp), FileError> {
    // The metadata come first: a later write then shows in a comparison.
    let metadata = ordinary(path)?;
    let bytes = fs::read(path).map_err(|error| FileError::reading(path, error))?;
    let stamp = Stamp::of_bytes(path, &metadata, &bytes);
    Ok((bytes, stamp))
}

/// The metadata of an ordinary file.
fn ordinary(path: &Path) -> Result<Metadata, FileError> {
    let refuse = |error| FileError::reading(path, error);
    let metadata = fs::metadata(path).map_err(refuse)?;
    if metadata.is_dir() {
        return Err(refuse(ErrorKind::IsADirectory.into()));
    }
    if !metadata.is_file() {
        return Err(refuse(in_words("it is not an ordinary file; give the path of one")));
    }
    Ok(metadata)
}

/// Reads a whole text file in UTF-8.
///
/// # Errors
/// The system's error, or text that is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    Ok(read_text_stamped(path)?.0)
}

/// Like [`read_text`], with the file's stamp.
///
/// # Errors
/// Those of [`read_text`].
pub fn read_text_stamped(path: &Path) -> Result<(String, Stamp), FileError> {
    let (bytes, stamp) = read_stamped(path)?;
    let text = String::from_utf8(bytes);
    let text = text.map_err(|_| FileError::reading(path, ErrorKind::InvalidData.into()))?;
    Ok((text, stamp))
}

/// Returns true if an ordinary file has exactly these bytes.
pub fn holds(path: &Path, bytes: &[u8]) -> bool {
    let has_length = ordinary(path).is_ok_and(|metadata| metadata.len() == bytes.len() as u64);
    let Some(mut file) = has_length.then(|| File::open(path).ok()).flatten() else {
        return false;
    };
    let mut block = vec![0; 1 << 16];
    let mut left = bytes;
    loop {
        match file.read(&mut block) {
            Ok(0) => return left.is_empty(),
            Ok(count) => match left.strip_prefix(&block[..count]) {
                Some(behind) => left = behind,
                None => return false,
            },
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(_) => return false,
        }
    }
}
