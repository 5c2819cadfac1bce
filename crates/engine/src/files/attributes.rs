//! The attributes that a new file takes over from the one it replaces: rights, owner, extended attributes, and its
//! other names.
//!
//! A rename puts a new file in the old one's place, so all of these must be copied to the new one first. The rights to
//! run as another user (setuid, setgid, file capabilities) belonged to the old bytes and are not copied.
//!
//! A file with several names (hard links) can't be replaced under all of them in one step, and writing over its bytes
//! would leave a torn file if the program is killed. So the names in its own folder are replaced one after the other,
//! each of them old or new and whole at every moment. Names in other folders, which can't be found, keep the old bytes,
//! and a warning says so.

use std::fs::{File, Metadata};
use std::io;
use std::path::{Path, PathBuf};

use crate::path_text::folder_of;

/// The other names of a replaced file.
#[derive(Debug, Default)]
pub(super) struct OtherNames {
    /// The names in its own folder.
    pub here: Vec<PathBuf>,
    /// The number of names elsewhere.
    pub elsewhere: u64,
}

/// Copies the attributes of `existing`, the file at `target`, to the new file. Attributes that the system refuses are
/// left out, but the rights never become wider than before.
///
/// # Errors
/// Not even the rights can be set.
#[cfg(unix)]
pub(super) fn hand_on(new: &File, existing: &Metadata, target: &Path) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let own = new.metadata()?;
    let mut rights = existing.mode() & 0o777;
    if own.uid() != existing.uid() {
        // Only the superuser may give files away.
        let _ = fchown(new, Some(existing.uid()), None);
    }
    if own.gid() != existing.gid() && fchown(new, None, Some(existing.gid())).is_err() {
        // Another group must not get this group's rights: it gets everybody's.
        rights = (rights & 0o707) | ((rights & 0o007) << 3);
    }
    new.set_permissions(std::fs::Permissions::from_mode(rights))?;
    copy_extended(new, target);
    Ok(())
}

/// Lets only the owner read and write a file.
///
/// # Errors
/// The system's error.
#[cfg(unix)]
pub(super) fn make_private(file: &File) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o600))
}

#[cfg(not(unix))]
pub(super) fn make_private(_file: &File) -> io::Result<()> {
    Ok(())
}

#[cfg(not(unix))]
pub(super) fn hand_on(new: &File, existing: &Metadata, _target: &Path) -> io::Result<()> {
    new.set_permissions(existing.permissions())
}

/// Copies extended attributes, including access control lists, as far as the system allows.
#[cfg(any(target_os = "linux", target_os = "macos"))]
fn copy_extended(new: &File, target: &Path) {
    use rustix::fs::{XattrFlags, fsetxattr, getxattr, getxattr_query, listxattr, listxattr_query};
    // They may change meanwhile; then the size is wrong, and the call fails.
    let sized = |size: usize| vec![0_u8; size];
    let Ok(mut names) = listxattr_query(target).map(sized) else {
        return;
    };
    let Ok(length) = listxattr(target, &mut *names) else {
        return;
    };
    for name in names[..length].split(|byte| *byte == 0) {
        if name.is_empty() || name == b"security.capability" {
            continue;
        }
        let Ok(mut value) = getxattr_query(target, name).map(sized) else {
            continue;
        };
        if let Ok(length) = getxattr(target, name, &mut *value) {
            let _ = fsetxattr(new, name, &value[..length], XattrFlags::empty());
        }
    }
}

#[cfg(all(unix, not(any(target_os = "linux", target_os = "macos"))))]
fn copy_extended(_new: &File, _target: &Path) {}

/// Finds the other names of the file at `target`.
#[cfg(unix)]
pub(super) fn other_names(existing: &Metadata, target: &Path) -> OtherNames {
    use std::os::unix::fs::MetadataExt;
    if existing.nlink() < 2 {
        return OtherNames::default();
    }
    let node = (existing.dev(), existing.ino());
    let entries = std::fs::read_dir(folder_of(target)).into_iter().flatten().flatten();
    // This is the entry's own metadata, which follows no link.
    let same = entries.filter(|entry| entry.metadata().is_ok_and(|other| (other.dev(), other.ino()) == node));
    let here: Vec<PathBuf> = same.map(|entry| entry.path()).filter(|path| path != target).collect();
    OtherNames {
        elsewhere: (existing.nlink() - 1).saturating_sub(here.len() as u64),
        here,
    }
}

#[cfg(not(unix))]
pub(super) fn other_names(_existing: &Metadata, _target: &Path) -> OtherNames {
    OtherNames::default()
}
