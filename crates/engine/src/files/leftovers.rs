//! The temporary files of a save, and the removal of those that a killed save has left.
//!
//! There are temporary files (`.pliant-XXXXXX.tmp`, and `.old` for files to restore if a save fails half-way), which
//! nothing names; and neighbours under passing names (`.pliant-` and 16 hex digits and `-` and the name), which a glTF
//! may name during its replacement.

use std::collections::BTreeSet;
use std::fs;
use std::hash::{BuildHasher, Hasher as _, RandomState};
use std::path::Path;

use super::named::names_in_folder;

/// The beginning of all their names.
pub(super) const PREFIX: &str = ".pliant-";
/// The end of a file during its writing.
pub(super) const TEMPORARY: &str = ".tmp";
/// The end of a file during its replacement.
pub(super) const REPLACED: &str = ".old";

/// The number of letters and digits between the two in a temporary file's name.
pub(super) const RANDOM: usize = 6;

/// The longest part of a name that a passing name keeps, in bytes: file systems end names at 255.
const LONGEST: usize = 200;

/// A passing name for the neighbour `name`, in the folder of the file that names it.
pub(crate) fn passing_name(name: &str) -> String {
    let flat = name.replace('%', "%25").replace('/', "%2F");
    let mut from = flat.len().saturating_sub(LONGEST);
    while !flat.is_char_boundary(from) {
        from += 1;
    }
    format!(
        "{PREFIX}{:016x}-{}",
        RandomState::new().build_hasher().finish(),
        &flat[from..]
    )
}

/// The name of a neighbour, without the passing part.
pub(super) fn real_name(name: &str) -> String {
    match behind_passing(name) {
        Some(flat) => flat.replace("%2F", "/").replace("%25", "%"),
        None => name.to_owned(),
    }
}

/// Returns true if a neighbour has a passing name.
pub(super) fn is_passing(name: &str) -> bool {
    behind_passing(name).is_some()
}

fn behind_passing(name: &str) -> Option<&str> {
    let (digits, flat) = name.strip_prefix(PREFIX)?.split_once('-')?;
    let is_ours = digits.len() == 16 && digits.bytes().all(|byte| byte.is_ascii_hexdigit()) && !flat.is_empty();
    is_ours.then_some(flat)
}

/// Returns true if a name is that of a temporary file of a save. Other files may begin and end like these.
fn is_temporary(name: &str) -> bool {
    let middle = name.strip_prefix(PREFIX).and_then(|rest| {
        let ends = [TEMPORARY, REPLACED];
        ends.iter().find_map(|end| rest.strip_suffix(end))
    });
    middle.is_some_and(|middle| middle.len() == RANDOM && middle.bytes().all(|byte| byte.is_ascii_alphanumeric()))
}

/// Removes the files that killed saves have left in a folder. The caller must have its lock alone.
pub(super) fn clear(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let mut passing = Vec::new();
    for entry in entries.flatten() {
        let name = entry.file_name();
        let Some(name) = name.to_str().filter(|name| name.starts_with(PREFIX)) else {
            continue;
        };
        if !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        if is_temporary(name) {
            // A file that can't be removed does no harm.
            let _ = fs::remove_file(entry.path());
        } else if is_passing(name) {
            passing.push(name.to_owned());
        }
    }
    if passing.is_empty() {
        return;
    }
    // A save that was killed half-way has left a glTF that names these.
    let Some(named): Option<BTreeSet<String>> = names_in_folder(folder, None) else {
        return;
    };
    for name in passing.iter().filter(|name| !named.contains(*name)) {
        let _ = fs::remove_file(folder.join(name));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_passing_name_tells_the_real_one() {
        for name in ["scene.bin", "textures/a b.png", "100%/50%2F.bin", "漢字.bin"] {
            let passing = passing_name(name);
            assert!(is_passing(&passing) && !passing.contains('/'), "{passing}");
            assert_eq!(real_name(&passing), name);
            assert_eq!(real_name(name), name);
        }
        assert!(passing_name(&"é".repeat(127)).len() <= 255);
        for name in [
            ".pliant-abc.tmp",
            ".pliant-0123456789abcdef-",
            "scene.bin",
            ".pliant.lock",
        ] {
            assert!(!is_passing(name), "{name}");
        }
    }
}
