//! The file to which a path leads, under any name.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use crate::EngineError;
use crate::file_error::in_words;
use crate::path_text::{folder_of, shown};

/// The most links to links that are followed, as in the system.
const MOST_LINKS: usize = 40;

/// The place to which a path leads through all links, with its folder in its true spelling. The file itself need not
/// exist: a link may lead to a future file.
///
/// # Errors
/// A folder on the way is missing or unreadable, or the path does not end in a name.
pub fn follow(path: &Path) -> io::Result<PathBuf> {
    let mut at = path.to_owned();
    for _ in 0..MOST_LINKS {
        let name = at.file_name().ok_or(ErrorKind::IsADirectory)?.to_owned();
        let folder = fs::canonicalize(folder_of(&at))?;
        if !folder.is_dir() {
            return Err(ErrorKind::NotADirectory.into());
        }
        at = folder.join(name);
        match fs::symlink_metadata(&at) {
            Ok(metadata) if metadata.is_symlink() => at = folder.join(fs::read_link(&at)?),
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
            _ => return Ok(at),
        }
    }
    Err(in_words("its links form a circle; remove them"))
}

/// A file's identity in the system.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Identity {
    /// The identity of an existing file, which hard links share.
    #[cfg(unix)]
    Node { device: u64, number: u64 },
    /// The only place of a file that does not exist.
    Place(PathBuf),
}

pub(super) fn identity(path: &Path) -> Option<Identity> {
    let place = follow(path).ok()?;
    #[cfg(unix)]
    if let Ok(metadata) = fs::metadata(&place) {
        use std::os::unix::fs::MetadataExt;
        return Some(Identity::Node {
            device: metadata.dev(),
            number: metadata.ino(),
        });
    }
    if place.exists() {
        return fs::canonicalize(&place).ok().map(Identity::Place);
    }
    let folder = folder_of(&place);
    let name = place.file_name().unwrap_or_default();
    Some(Identity::Place(if folds_case(folder) {
        folder.join(name.to_string_lossy().to_lowercase())
    } else {
        place
    }))
}

/// Returns true if two paths lead to one file, by links, hard links or another spelling. Files that don't exist yet are
/// one if they would become one.
pub fn is_same(a: &Path, b: &Path) -> bool {
    a == b || identity(a).is_some_and(|a| identity(b) == Some(a))
}

/// A set of files for many [`is_same`] queries, without comparing each with each.
#[derive(Clone, Default, Debug)]
pub struct FileSet {
    paths: BTreeSet<PathBuf>,
    identities: BTreeSet<Identity>,
}

impl FileSet {
    /// Adds the file to which a path leads now.
    pub fn insert(&mut self, path: PathBuf) {
        self.identities.extend(identity(&path));
        self.paths.insert(path);
    }

    /// Returns true if a path leads to one of the files.
    pub fn contains(&self, path: &Path) -> bool {
        self.paths.contains(path) || identity(path).is_some_and(|identity| self.identities.contains(&identity))
    }
}

/// Returns true if a folder's file system ignores case in names, tested with the folder's own name.
fn folds_case(folder: &Path) -> bool {
    let Some(name) = folder.file_name().and_then(OsStr::to_str) else {
        return cfg!(any(windows, target_os = "macos"));
    };
    let swap = |letter: char| {
        if letter.is_lowercase() {
            letter.to_uppercase().next()
        } else {
            letter.to_lowercase().next()
        }
    };
    let swapped: String = name.chars().filter_map(swap).collect();
    if swapped == name {
        return cfg!(any(windows, target_os = "macos"));
    }
    // Both must exist and lead to one folder.
    let other = fs::canonicalize(folder.with_file_name(swapped));
    other.is_ok_and(|other| fs::canonicalize(folder).is_ok_and(|folder| is_one_folder(&other, &folder)))
}

#[cfg(unix)]
fn is_one_folder(a: &Path, b: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let node = |path: &Path| fs::metadata(path).map(|metadata| (metadata.dev(), metadata.ino())).ok();
    node(a).is_some_and(|a| node(b) == Some(a))
}

#[cfg(not(unix))]
fn is_one_folder(a: &Path, b: &Path) -> bool {
    a == b
}

/// Refuses an output that is one of `others`, each with its description ("FILE", "--edit").
///
/// # Errors
/// [`EngineError::Arguments`], naming both.
pub fn refuse_shared<'a, 'b>(
    output: (&str, &Path),
    others: impl IntoIterator<Item = (&'a str, &'b Path)>,
) -> Result<(), EngineError> {
    let (role, path) = output;
    for (other_role, other) in others {
        if is_same(path, other) {
            return Err(EngineError::Arguments(format!(
                "{role} {} is also {other_role}: give it another name",
                shown(path)
            )));
        }
    }
    Ok(())
}

#[cfg(all(test, unix))]
#[expect(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_known_by_every_path_to_it() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("sub")).unwrap();
        fs::write(at("a"), "").unwrap();
        fs::write(at("b"), "").unwrap();
        fs::hard_link(at("a"), at("hard")).unwrap();
        std::os::unix::fs::symlink("a", at("soft")).unwrap();
        std::os::unix::fs::symlink("soft", at("softer")).unwrap();
        std::os::unix::fs::symlink("../new", at("sub/dangling")).unwrap();
        std::os::unix::fs::symlink("circle", at("circle")).unwrap();
        for name in ["./a", "sub/../a", "hard", "soft", "softer"] {
            assert!(is_same(&at("a"), &at(name)), "{name}");
            assert!(!is_same(&at("b"), &at(name)), "{name}");
        }
        assert!(is_same(&at("new"), &at("sub/dangling")) && is_same(&at("new"), &at("sub/../new")));
        assert!(!is_same(&at("new"), &at("newer")) && !is_same(&at("new"), &at("none/new")));
        // A set of files gives the same answer as each alone.
        let names = [
            "a",
            "./a",
            "b",
            "hard",
            "softer",
            "new",
            "newer",
            "sub/dangling",
            "none/new",
            "circle",
        ];
        for (count, first) in names.iter().enumerate() {
            let mut set = FileSet::default();
            let members = &names[..count];
            members.iter().for_each(|name| set.insert(at(name)));
            let is_one = members.iter().any(|name| is_same(&at(name), &at(first)));
            assert_eq!(set.contains(&at(first)), is_one, "{first} in {members:?}");
        }
        assert_eq!(
            follow(&at("sub/dangling")).unwrap(),
            fs::canonicalize(folder.path()).unwrap().join("new")
        );
        assert!(follow(&at("circle")).is_err() && follow(&at("none/x")).is_err());
    }
}
