//! The files that the glTFs in a folder name.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use pliant_io::neighbours_named;

use super::is_same;

/// A glTF's text beyond this size is not searched.
const LONGEST_TEXT: u64 = 256 << 20;

/// The files that the glTF in a folder name, except one glTF; `None` if one is too large to be parsed. Unreadable ones
/// name nothing.
pub(super) fn names_in_folder(folder: &Path, except: Option<&Path>) -> Option<BTreeSet<String>> {
    let mut names = BTreeSet::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let is_kind = |kind: &str| {
            path.extension()
                .is_some_and(|extension| extension.eq_ignore_ascii_case(kind))
        };
        let is_file = fs::metadata(&path).is_ok_and(|metadata| metadata.is_file());
        if !is_file || !(is_kind("gltf") || is_kind("glb")) || except.is_some_and(|except| is_same(except, &path)) {
            continue;
        }
        match text_of(&path) {
            Ok(Some(text)) => names.extend(neighbours_named(&text).into_iter().flatten()),
            Ok(None) => return None,
            Err(_) => {}
        }
    }
    Some(names)
}

/// The text of a glTF, or the JSON chunk of a GLB; `None` if it is too long.
fn text_of(path: &Path) -> io::Result<Option<Vec<u8>>> {
    let mut file = File::open(path)?;
    let mut length = file.metadata()?.len();
    let mut head = Vec::new();
    Read::by_ref(&mut file).take(20).read_to_end(&mut head)?;
    if let [b'g', b'l', b'T', b'F', _, _, _, _, _, _, _, _, a, b, c, d, ..] = head[..] {
        length = u64::from(u32::from_le_bytes([a, b, c, d]));
        head.clear();
    }
    if length > LONGEST_TEXT {
        return Ok(None);
    }
    let left = length.saturating_sub(head.len() as u64);
    file.take(left).read_to_end(&mut head)?;
    Ok(Some(head))
}
