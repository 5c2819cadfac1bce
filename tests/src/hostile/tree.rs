//! A case's folder on disk: writing it, and recording its content before and after a command.

use std::collections::BTreeMap;
use std::fs;
use std::hash::Hasher as _;
use std::io;
use std::os::unix::ffi::{OsStrExt as _, OsStringExt as _};
use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};
use std::process::Command;

use super::case::{Case, Entry};

/// The entry at a path.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum What {
    /// The file's length and a digest of its bytes.
    File(u64, u64),
    Folder,
    Link(PathBuf),
    /// A pipe, a socket or a device.
    Other,
}

/// A path's content, its permissions, and its file's identity.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Node {
    pub what: What,
    pub mode: u32,
    pub identity: (u64, u64),
}

/// Everything below a folder, by path relative to the folder.
pub type Tree = BTreeMap<PathBuf, Node>;

/// Writes a case's folder. Entries that the file system rejects (with a name that is too long) are left out.
pub fn lay(case: &Case, root: &Path) {
    let mut hard = Vec::new();
    for (place, entry) in &case.entries {
        let path = root.join(place);
        if let Some(folder) = path.parent() {
            let _ = fs::create_dir_all(folder);
        }
        let _ = match entry {
            Entry::File(bytes) => fs::write(&path, rooted(bytes, root)),
            Entry::ReadOnly(bytes) => fs::write(&path, rooted(bytes, root))
                .and_then(|()| fs::set_permissions(&path, fs::Permissions::from_mode(0o444))),
            Entry::Folder => fs::create_dir_all(&path),
            Entry::Link(target) => std::os::unix::fs::symlink(with_root(target.as_ref(), root), &path),
            Entry::Hard(other) => {
                hard.push((other, path));
                Ok(())
            }
            Entry::Fifo => Command::new("mkfifo").arg("--").arg(&path).output().map(|_| ()),
            Entry::Socket => std::os::unix::net::UnixListener::bind(&path).map(|_| ()),
        };
    }
    // The files that they link to exist now.
    for (other, path) in hard {
        let _ = fs::hard_link(root.join(other), path);
    }
}

/// A path with `@ROOT@` replaced by the case's folder.
pub fn with_root(path: &Path, root: &Path) -> PathBuf {
    std::ffi::OsString::from_vec(replaced(path.as_os_str().as_bytes(), root)).into()
}

/// A text with `@ROOT@` replaced. Other files stay unchanged, because they contain their own lengths.
fn rooted(bytes: &[u8], root: &Path) -> Vec<u8> {
    if bytes.starts_with(b"{") || bytes.starts_with(b"newmtl") {
        replaced(bytes, root)
    } else {
        bytes.to_vec()
    }
}

fn replaced(bytes: &[u8], root: &Path) -> Vec<u8> {
    const MARK: &[u8] = b"@ROOT@";
    let mut out = Vec::with_capacity(bytes.len());
    let mut rest = bytes;
    while let Some(at) = rest.windows(MARK.len()).position(|window| window == MARK) {
        out.extend_from_slice(&rest[..at]);
        out.extend_from_slice(root.as_os_str().as_bytes());
        rest = &rest[at + MARK.len()..];
    }
    out.extend_from_slice(rest);
    out
}

/// Records everything below a folder. It follows no links and opens only plain files.
pub fn look(root: &Path) -> Tree {
    let mut tree = Tree::new();
    let _ = walk(root, Path::new(""), &mut tree);
    tree
}

fn walk(root: &Path, folder: &Path, tree: &mut Tree) -> io::Result<()> {
    for entry in fs::read_dir(root.join(folder))? {
        let entry = entry?;
        let place = folder.join(entry.file_name());
        let metadata = fs::symlink_metadata(entry.path())?;
        let kind = metadata.file_type();
        let what = if kind.is_dir() {
            walk(root, &place, tree)?;
            What::Folder
        } else if kind.is_symlink() {
            What::Link(fs::read_link(entry.path())?)
        } else if kind.is_file() {
            let mut hasher = std::hash::DefaultHasher::new();
            hasher.write(&fs::read(entry.path())?);
            What::File(metadata.len(), hasher.finish())
        } else {
            What::Other
        };
        let node = Node {
            what,
            mode: metadata.mode(),
            identity: (metadata.dev(), metadata.ino()),
        };
        tree.insert(place, node);
    }
    Ok(())
}

/// The place of a path after following links, with or without a file there. `None` for a path without a place.
pub fn place_of(path: &Path) -> Option<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..40 {
        let folder = fs::canonicalize(path.parent()?).ok()?;
        let Some(name) = path.file_name() else {
            return fs::canonicalize(&path).ok();
        };
        let plain = folder.join(name);
        match fs::read_link(&plain) {
            Ok(target) => path = folder.join(target),
            Err(_) => return Some(plain),
        }
    }
    None
}
