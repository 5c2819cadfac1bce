//! Reading and writing files, with sentences for failures.

use std::fs;
use std::path::{Path, PathBuf};

/// Makes an empty folder, removing earlier content.
///
/// # Errors
/// One sentence naming the folder.
pub fn fresh_folder(folder: &Path) -> Result<(), String> {
    remove_folder(folder)?;
    fs::create_dir_all(folder).map_err(|e| format!("{} can't be made: {e}.", folder.display()))
}

/// Removes a folder with its content, if it exists.
///
/// # Errors
/// One sentence naming the folder.
pub fn remove_folder(folder: &Path) -> Result<(), String> {
    match fs::remove_dir_all(folder) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
            Err(format!("{} can't be removed: {e}.", folder.display()))
        }
        _ => Ok(()),
    }
}

/// Removes a file.
///
/// # Errors
/// One sentence naming the file.
pub fn remove_file(file: &Path) -> Result<(), String> {
    fs::remove_file(file).map_err(|e| format!("{} can't be removed: {e}.", file.display()))
}

/// Writes a file, and makes its folder.
///
/// # Errors
/// One sentence naming the file.
pub fn write(file: &Path, bytes: impl AsRef<[u8]>) -> Result<(), String> {
    let folder = file.parent().unwrap_or(file);
    let written = fs::create_dir_all(folder).and_then(|()| fs::write(file, bytes));
    written.map_err(|e| format!("{} can't be written: {e}.", file.display()))
}

/// The bytes of a file.
///
/// # Errors
/// One sentence naming the file.
pub fn read(file: &Path) -> Result<Vec<u8>, String> {
    fs::read(file).map_err(|e| format!("{} can't be read: {e}.", file.display()))
}

/// The text of a file of the workspace, by its path from the root.
///
/// # Errors
/// One sentence naming the file.
pub fn text(path: &str) -> Result<String, String> {
    let file = crate::root::root().join(path);
    String::from_utf8(read(&file)?).map_err(|e| format!("{} is not UTF-8: {e}.", file.display()))
}

/// Copies a file, and makes its new folder. The copy keeps the permissions, but not the time.
///
/// # Errors
/// One sentence naming the file.
pub fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let folder = to.parent().unwrap_or(to);
    let copied = fs::create_dir_all(folder).and_then(|()| fs::copy(from, to));
    copied
        .map(drop)
        .map_err(|e| format!("{} can't be copied to {}: {e}.", from.display(), to.display()))
}

/// Copies a folder with its content.
///
/// # Errors
/// One sentence naming the failed copy.
pub fn copy_folder(from: &Path, to: &Path) -> Result<(), String> {
    for file in all_files(from)? {
        copy(&from.join(&file), &to.join(&file))?;
    }
    Ok(())
}

/// The files in a folder and in those inside it, as paths from it, sorted.
///
/// # Errors
/// One sentence naming the folder that can't be read.
pub fn all_files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let mut files = Vec::new();
    let mut open = vec![PathBuf::new()];
    while let Some(inner) = open.pop() {
        let cannot = |e: std::io::Error| format!("{} can't be read: {e}.", folder.join(&inner).display());
        for entry in fs::read_dir(folder.join(&inner)).map_err(cannot)? {
            let entry = entry.map_err(cannot)?;
            let path = inner.join(entry.file_name());
            if entry.file_type().map_err(cannot)?.is_dir() {
                open.push(path);
            } else {
                files.push(path);
            }
        }
    }
    files.sort();
    Ok(files)
}
