//! The form of paths in texts and messages.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// The folder of a path, "." for a bare name.
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A file's name in a glTF's URIs; one that is not UTF-8 is percent-encoded.
pub fn name_as_text(name: &OsStr) -> String {
    #[cfg(unix)]
    {
        pliant_io::name_of_bytes(std::os::unix::ffi::OsStrExt::as_bytes(name))
    }
    #[cfg(not(unix))]
    {
        name.to_string_lossy().into_owned()
    }
}

/// A path with `/` between its folders, each named by [`name_as_text`]; [`path_of_text`] reads it back.
pub fn path_as_text(path: &Path) -> String {
    if cfg!(not(unix)) {
        return path.to_string_lossy().replace('\\', "/");
    }
    let names: Vec<String> = path.iter().map(name_as_text).collect();
    names.join("/").replacen("//", "/", usize::from(path.is_absolute()))
}

/// The path that a text names, as seen from `folder`; see [`path_as_text`].
pub fn path_of_text(folder: &Path, text: &str) -> PathBuf {
    neighbour_path(folder, text)
}

/// The path in `folder` of a neighbour's name; see [`name_as_text`]. A file with exactly these letters has priority.
pub(crate) fn neighbour_path(folder: &Path, name: &str) -> PathBuf {
    let literal = folder.join(name);
    #[cfg(unix)]
    if name.contains('%') && std::fs::symlink_metadata(&literal).is_err() {
        use std::os::unix::ffi::OsStringExt;
        let step = |step: &str| match pliant_io::bytes_of_name(step) {
            Some(bytes) if !bytes.contains(&b'/') && !bytes.contains(&0) => std::ffi::OsString::from_vec(bytes),
            _ => step.into(),
        };
        let mut path = folder.to_owned();
        if name.starts_with('/') {
            path.push("/");
        }
        path.extend(name.split('/').filter(|step| !step.is_empty()).map(step));
        return path;
    }
    literal
}

/// A path for a message: on one line and without control characters.
pub fn shown(path: &Path) -> String {
    pliant_io::quoted(&path.to_string_lossy())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_path_comes_back_from_its_text_whatever_bytes_are_in_it() {
        use std::os::unix::ffi::OsStringExt;
        let folder = Path::new("/somewhere");
        let odd = PathBuf::from(std::ffi::OsString::from_vec(b"caf\xe9/sc\xffan.ply".to_vec()));
        for path in [
            Path::new("scan.ply"),
            Path::new("a\\b/c d.ply"),
            Path::new("a/../b.ply"),
            &odd,
        ] {
            assert_eq!(path_of_text(folder, &path_as_text(path)), folder.join(path));
            let whole = Path::new("/").join(path);
            assert_eq!(path_of_text(folder, &path_as_text(&whole)), whole);
        }
    }
}
