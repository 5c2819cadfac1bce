//! The paths of the files that a model names: a glTF's or GLB's buffers and images, an OBJ's libraries and textures.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs;
use std::os::unix::ffi::OsStringExt as _;
use std::path::{Path, PathBuf};

use super::json_text;
use super::tree::place_of;

/// The paths of a model's neighbours. If the model is a link, each neighbour may be in the folder to which the link
/// leads or in the link's own.
///
/// Every text that a reader may use as a name counts, because a file that is broken elsewhere may still be read.
pub fn neighbours_of(path: &Path) -> BTreeSet<PathBuf> {
    let mut folders = vec![path.with_file_name("")];
    folders.extend(place_of(path).map(|place| place.with_file_name("")));
    let Some(bytes) = read(path) else {
        return BTreeSet::new();
    };
    // The target of a link may have any extension.
    let of_obj = of_obj(&bytes, &folders).into_iter().map(OsString::from);
    let names: BTreeSet<OsString> = of_gltf(&bytes).into_iter().chain(of_obj).collect();
    let pairs = folders.iter().flat_map(|folder| {
        names
            .iter()
            .filter(|name| !name.is_empty())
            .map(move |name| folder.join(name))
    });
    pairs.filter_map(|place| place_of(&place)).collect()
}

fn read(path: &Path) -> Option<Vec<u8>> {
    let is_plain = fs::metadata(path).is_ok_and(|metadata| metadata.is_file());
    is_plain.then(|| fs::read(path).ok()).flatten()
}

/// An OBJ's libraries, and the textures that each library names. A texture is looked up relative to the library's path
/// as the OBJ spells it, even if links lead to the library, or by its bare name beside the OBJ, in case its path comes
/// from another computer.
fn of_obj(text: &[u8], folders: &[PathBuf]) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for library in rests(text, |word| word == "mtllib") {
        // The whole line may be one name, or each word may be one.
        let libraries = [&*library].into_iter().chain(library.split_whitespace());
        for library in libraries.map(path_of) {
            let beside = library.rfind('/').map_or("", |end| &library[..=end]);
            let texts = folders.iter().filter_map(|folder| read(&folder.join(&library)));
            for texture in texts.flat_map(|text| rests(&text, |word| word.starts_with("map_"))) {
                // Options come before a texture's name.
                let last = texture.rsplit(' ').next().unwrap_or(&texture);
                for texture in [&*texture, last].map(path_of) {
                    let bare = texture.rsplit('/').next().unwrap_or(&texture);
                    names.extend([format!("{beside}{texture}"), bare.to_owned()]);
                }
            }
            names.insert(library);
        }
    }
    names
}

/// The rest of each line that begins with a wanted keyword.
fn rests(text: &[u8], is_wanted: impl Fn(&str) -> bool) -> Vec<String> {
    let text = String::from_utf8_lossy(text);
    let lines = text.split(['\n', '\r']);
    let pairs = lines.filter_map(|line| line.trim().split_once(char::is_whitespace));
    pairs
        .filter(|(word, _)| is_wanted(word))
        .map(|(_, rest)| rest.trim().to_owned())
        .collect()
}

/// A name in an OBJ or a library as a path.
fn path_of(name: &str) -> String {
    name.trim().trim_matches('"').replace('\\', "/")
}

/// The URIs of a glTF or a GLB, and the same with backslashes read as slashes.
fn of_gltf(bytes: &[u8]) -> BTreeSet<OsString> {
    let text = if bytes.starts_with(b"glTF") {
        let length = bytes
            .get(12..)
            .and_then(|rest| rest.first_chunk())
            .map_or(0, |word| u32::from_le_bytes(*word));
        bytes.get(20..20 + length as usize).unwrap_or_default()
    } else {
        bytes
    };
    let uris = json_text::texts_of(text, "uri").into_iter();
    let paths = uris.filter(|uri| !uri.starts_with("data:")).map(|uri| decoded(&uri));
    paths
        .flat_map(|path| [slashed(&path), path])
        .map(|path| OsString::from_vec(without_dots(&path)))
        .collect()
}

fn slashed(path: &[u8]) -> Vec<u8> {
    let slash = |byte: &u8| if *byte == b'\\' { b'/' } else { *byte };
    path.iter().map(slash).collect()
}

/// A path with its `.` and `..` segments removed as far as possible: a URI's are removed from its text (RFC 3986,
/// 5.2.4), independent of the disk.
fn without_dots(path: &[u8]) -> Vec<u8> {
    let mut steps: Vec<&[u8]> = Vec::new();
    for step in path.split(|byte| *byte == b'/') {
        match step {
            b"." => {}
            b"" if !steps.is_empty() || !path.starts_with(b"/") => {}
            b".." if steps.last().is_some_and(|last| !matches!(*last, b"" | b"..")) => drop(steps.pop()),
            step => steps.push(step),
        }
    }
    steps.join(&b'/')
}

/// A URI with its percent escapes decoded. The bytes of a name need not be UTF-8.
fn decoded(uri: &str) -> Vec<u8> {
    let bytes = uri.as_bytes();
    let mut out = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let hex = (bytes[at] == b'%').then(|| uri.get(at + 1..at + 3)).flatten();
        match hex.and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(byte) => {
                out.push(byte);
                at += 3;
            }
            None => {
                out.push(bytes[at]);
                at += 1;
            }
        }
    }
    out
}
