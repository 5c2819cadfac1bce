//! Other names for the files that an OBJ and its libraries name, in their texts.

use super::materials::{as_uri, behind_options, folder_of, join};
use crate::text::{Splice, mark_len};

/// An OBJ with `new` in place of the material library `old`; `None` if it does not name that one plainly.
pub(crate) fn library_renamed(obj: &[u8], old: &str, new: &str) -> Option<Vec<u8>> {
    renamed(obj, |keyword, rest| {
        if keyword != "mtllib" {
            return Vec::new();
        }
        // As in reading: the whole line is one name, or else a part of it between blanks.
        let names = if as_uri(rest) == old {
            vec![rest.trim()]
        } else if old.contains(' ') {
            rest.match_indices(old).map(|(_, name)| name).collect()
        } else {
            rest.split_whitespace().filter(|word| as_uri(word) == old).collect()
        };
        names
            .into_iter()
            .map(|name| (place_in(name, rest), new.to_owned()))
            .collect()
    })
}

/// A material library with `new` in place of the texture `old`, both relative to the OBJ's folder, like the library's
/// own path; `None` if it does not name that one.
pub(crate) fn texture_renamed(text: &[u8], library: &str, old: &str, new: &str) -> Option<Vec<u8>> {
    let folder = folder_of(library);
    let bare = old.rsplit('/').next().unwrap_or(old);
    renamed(text, |keyword, rest| {
        if keyword != "map_Kd" {
            return Vec::new();
        }
        let (file, _) = behind_options(rest);
        let uri = join(folder, &as_uri(file));
        // A texture that was read beside the OBJ may be named by its path on another computer.
        let is_named = uri == old || (old == bare && uri.rsplit('/').next() == Some(bare));
        let from_library = match new.strip_prefix(folder) {
            Some(inside) => inside.to_owned(),
            None => "../".repeat(folder.matches('/').count()) + new,
        };
        is_named
            .then(|| (place_in(file, rest), from_library))
            .into_iter()
            .collect()
    })
}

/// The text with the replacements that `of_line` returns for each line, given its keyword and the rest: places in the
/// rest and their new text.
fn renamed(text: &[u8], of_line: impl Fn(&str, &str) -> Vec<(std::ops::Range<usize>, String)>) -> Option<Vec<u8>> {
    let mut splice = Splice::new(text);
    let mut has_changed = false;
    let mut start = mark_len(text);
    for line in text[start..].split_inclusive(|byte| matches!(byte, b'\n' | b'\r')) {
        let at = start;
        start += line.len();
        // A name that is not UTF-8 is read with substitutes, so its place is unknown.
        let Ok(line) = std::str::from_utf8(line) else { continue };
        let trimmed = line.trim_start();
        let keyword = trimmed.split_whitespace().next().unwrap_or_default();
        let rest_at = at + (line.len() - trimmed.len()) + keyword.len();
        for (place, new) in of_line(keyword, &trimmed[keyword.len()..]) {
            has_changed = true;
            splice.replace(rest_at + place.start..rest_at + place.end, |out| {
                out.extend_from_slice(new.as_bytes())
            });
        }
    }
    has_changed.then(|| splice.finish())
}

/// The place of a part of a text in it.
fn place_in(part: &str, text: &str) -> std::ops::Range<usize> {
    let start = part.as_ptr() as usize - text.as_ptr() as usize;
    start..start + part.len()
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn only_the_name_changes() {
        let obj = b"# mtllib scan.mtl\r\nmtllib scan.mtl\r\nv 0 0 0\nmtllib other.mtl scan.mtl\n";
        let new = library_renamed(obj, "scan.mtl", "scan-2.mtl").unwrap();
        assert_eq!(
            String::from_utf8(new).unwrap(),
            "# mtllib scan.mtl\r\nmtllib scan-2.mtl\r\nv 0 0 0\nmtllib other.mtl scan-2.mtl\n"
        );
        assert_eq!(library_renamed(obj, "none.mtl", "x.mtl"), None);
        let mtl = b"newmtl a\n map_Kd -s 1 1 1 my tex.png\nmap_Ks my tex.png\nmap_Kd C:\\x\\b.png";
        let new = texture_renamed(mtl, "scan.mtl", "my tex.png", "my tex-2.png").unwrap();
        assert_eq!(
            String::from_utf8(new).unwrap(),
            "newmtl a\n map_Kd -s 1 1 1 my tex-2.png\nmap_Ks my tex.png\nmap_Kd C:\\x\\b.png"
        );
        let new = texture_renamed(mtl, "scan.mtl", "b.png", "b-2.png").unwrap();
        assert!(new.ends_with(b"map_Kd b-2.png"));
        let inside = texture_renamed(b"map_Kd t/a.png\n", "m/scan.mtl", "m/t/a.png", "m/t/a-2.png").unwrap();
        assert_eq!(inside, b"map_Kd t/a-2.png\n");
        let flat = texture_renamed(b"map_Kd t/a.png\n", "m/scan.mtl", "m/t/a.png", "a.png").unwrap();
        assert_eq!(flat, b"map_Kd ../a.png\n");
    }
}
